"""Optimisers: each asks for points of the unit cube to be evaluated, and is told what came out."""
