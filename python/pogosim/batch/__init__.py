"""Batches: many runs of one program, with every combination of the options in a configuration.

`pogosim.pogobatch` is the interface; these modules are what it consists of.
"""
