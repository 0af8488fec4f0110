"""Builds for other machines: older C libraries, other processors, macOS."""
