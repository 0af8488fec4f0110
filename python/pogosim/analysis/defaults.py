"""Defaults of analyses that command lines mention."""

# Slower robots have no direction. Positions are saved to about 0.0001 mm, a pogobot drives at 60 mm/s or more.
MIN_SPEED_MM_S = 0.1
