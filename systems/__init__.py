"""What happens each tick and each frame: one esper processor a file."""
