"""Where two runs or two batches differ: configurations, rows, and the distributions of their numbers."""
