"""Defaults, once each: those of keys of configurations, for what has no resolved configuration, and of options."""

# Keys of a pogobot: radius, communication_radius. Data files of earlier versions do not say them.
POGOBOT_RADIUS_MM = 26.5
COMMUNICATION_RADIUS_MM = 80.0

AREA_MM2 = 1.0e6  # of the key arena_surface

# Slower robots have no direction. Positions are saved to about 0.0001 mm, a pogobot drives at 60 mm/s or more.
MIN_SPEED_MM_S = 0.1
