"""Learners: each is one file, a program, and a function that the benchmark calls."""
