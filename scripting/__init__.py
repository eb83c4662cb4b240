"""What a script holds."""
