"""Makes conf/example_magnetometer_reference.csv: readings of a magnetometer at known headings.

    .venv/bin/python scripts/make_magnetometer_reference.py

The readings are invented: an ellipse that is neither centred nor aligned, two harmonics, and noise.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from pathlib import Path

TABLE = Path(__file__).resolve().parents[1] / "conf" / "example_magnetometer_reference.csv"
READINGS = 4  # at each heading
STEP_DEG = 5
NOISE = 2.5  # counts
CENTRE = (412.0, 437.0, 431.0)
# Amplitudes of x, y and z, counts, by the order of the harmonic.
COSINE = {1: (151.0, 24.0, 14.0), 2: (9.0, -5.0, 1.5), 3: (-2.0, 1.0, 0.5)}
SINE = {1: (-18.0, 137.0, -9.0), 2: (1.0, 6.0, -1.0), 3: (1.5, 2.0, 0.0)}
HEAD = """# Readings of a magnetometer of a robot that is turned, clockwise seen from above; the field points to 0.
# angle: heading of the robot, degrees; mag_x, mag_y, mag_z: counts. Made by scripts/make_magnetometer_reference.py.
angle,mag_x,mag_y,mag_z
"""


def rows() -> Iterator[str]:
    """Return the lines of the table."""
    draws = random.Random(20261125)
    for degrees in range(0, 360, STEP_DEG):
        angle = math.radians(-degrees)  # of the field, in the robot's frame
        for _ in range(READINGS):
            counts = [
                centre
                + sum(COSINE[k][axis] * math.cos(k * angle) + SINE[k][axis] * math.sin(k * angle) for k in COSINE)
                + draws.gauss(0.0, NOISE)
                for axis, centre in enumerate(CENTRE)
            ]
            yield ",".join([str(degrees), *(f"{count:.0f}" for count in counts)])


def text() -> str:
    """Return the whole table."""
    return HEAD + "\n".join(rows()) + "\n"


if __name__ == "__main__":
    TABLE.write_text(text(), encoding="utf-8")
