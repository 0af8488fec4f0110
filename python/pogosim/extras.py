"""Optional packages of this Pogosim, and how to install them.

PyPI has another program by the name of pogosim, and not this one, pogobot-simulator. So packages are installed by their
own names; see docs/other_pogosim.md.
"""

from __future__ import annotations

import shlex
import sys

# As in pyproject.toml.
EXTRAS = {
    "dask": ("distributed>=2023.5",),
    "slurm": ("dask-jobqueue>=0.8.5", "cryptography>=41", "distributed>=2023.5"),
    "watch": ("websockets>=14",),
    "notebook": ("anywidget>=0.9",),
    "learning": ("gymnasium>=1.0,<2", "pettingzoo>=1.25,<2"),
    "policy": ("onnx>=1.16",),
    "optim": ("optuna>=4.0", "ribs>=0.12"),  # its name in the original simulator
    "optimize": ("optuna>=4.0", "ribs>=0.12"),
}


def installing(extra: str) -> str:
    """Return the command that adds the packages of an extra to this Python."""
    return shlex.join([sys.executable, "-m", "pip", "install", *EXTRAS[extra]])
