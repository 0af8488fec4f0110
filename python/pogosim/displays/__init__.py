"""Displays: what the window needs of one, whether it opens here, and why it does not."""
