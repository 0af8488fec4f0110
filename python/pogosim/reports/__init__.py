"""What `pogosim analyze` writes: tables and figures of the analyses in `pogosim.analysis`."""
