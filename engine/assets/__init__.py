"""Characters and motions: read from files, written to them, built in."""
