"""Magnetometers of real robots: their readings at known headings, and the configuration that reproduces them."""
