"""Units in which tracks may be."""

import math

RARE_LENGTHS_MM = {"um": 0.001, "inch": 25.4}  # that only files say
LENGTHS_MM = {"mm": 1.0, "cm": 10.0, "m": 1000.0}
ANGLES_RAD = {"rad": 1.0, "deg": math.pi / 180.0}
