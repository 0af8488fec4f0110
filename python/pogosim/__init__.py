"""Tools for the Pogosim simulator of Pogobot swarms."""

__version__ = "0.11.0"
