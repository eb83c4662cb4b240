"""What the systems call: pure functions and small classes, with no esper and no systems in sight."""
