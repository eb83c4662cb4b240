"""The crowd before it moves: seats, stadium, motions, looks, and who is seen how."""
