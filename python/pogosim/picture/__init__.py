"""Drawing a run: reading its data file, and the layers of a picture."""
