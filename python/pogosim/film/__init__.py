"""Films and replays of a run, from its data file alone."""
