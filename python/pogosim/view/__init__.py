"""The picture of a swarm in a browser: one program for recorded runs, live runs and notebooks."""
