"""A run or a batch as one page that can be sent: what was run, a replay, figures, warnings."""
