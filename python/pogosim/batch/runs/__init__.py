"""One run: what it is known by, its files, and the simulator that does it."""
