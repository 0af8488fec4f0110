"""Files of results: the rows of many runs, and manifests that say what they are of."""
