"""What does runs: processes of this machine, Dask, and jobs of batch systems."""
