"""From simulation to reality: the motion parameters of robots, from their tracked trajectories."""
