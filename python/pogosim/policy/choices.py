"""What one may choose of a policy, as words."""

from __future__ import annotations

ACTIVATIONS = ("identity", "relu", "hardtanh", "tanh", "sigmoid")  # hardtanh: cut to -1 to 1
NUMBERS = ("float", "int16", "int8")  # floats of 32 bits, or whole numbers with weights of 16 or 8 bits
