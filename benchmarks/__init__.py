"""What ``tifo bench`` runs."""
