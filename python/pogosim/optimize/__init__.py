"""Tuning the parameters of a program: a search for those that make an objective as large as possible."""
