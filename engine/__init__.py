"""What the systems call: pure functions and small classes that know neither esper nor systems."""
