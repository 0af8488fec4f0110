"""Routines that the compiler and the C library bring along, by what they are for: the processor has no FPU."""

from __future__ import annotations

import re
from dataclasses import dataclass

# Functions of math.h; those of floats have an f at the end.
MATHS = (
    "acos|acosh|asin|asinh|atan|atan2|atanh|cbrt|ceil|cos|cosh|erf|erfc|exp|exp10|exp2|expm1|fabs|fdim|floor|fma|fmax|fmin"
    "|fmod|frexp|hypot|ldexp|lgamma|log|log10|log1p|log2|lrint|lround|modf|nearbyint|pow|remainder|remquo|rint|round|scalbn"
    "|sin|sincos|sinh|sqrt|tan|tanh|tgamma|trunc"
)


@dataclass(frozen=True)
class Family:
    """Routines for the same purpose.

    Attributes:
        title: What they are.
        names: Their names, as a pattern of the whole name.
        has_operators: Whether a line of source calls them by operators of C, not by their names.
    """

    title: str
    names: re.Pattern[str]
    has_operators: bool = False

    def has(self, name: str) -> bool:
        """Tell whether a routine is one of the family."""
        return self.names.fullmatch(name) is not None


# The C libraries have aliases with underscores, of which debug information may name any: _sin, __ieee754_pow.
DOUBLE_MATHS = Family("double", re.compile(rf"(?:__ieee754_|__kernel_|_{{0,2}})(?:{MATHS})"))
FLOAT_MATHS = Family("float", re.compile(rf"(?:__ieee754_|__kernel_|_{{0,2}})(?:{MATHS})f"))
DOUBLE = Family(
    "double",
    re.compile(
        r"__(?:add|sub|mul|div|neg)df[23]|__(?:eq|ne|lt|le|gt|ge|cmp|unord)df2|__powidf2"
        r"|__fix(?:uns)?df[sd]i|__float(?:un)?[sd]idf|__extendsfdf2|__truncdfsf2"
    ),
    has_operators=True,
)
FLOAT = Family(
    "float",
    re.compile(
        r"__(?:add|sub|mul|div|neg)sf[23]|__(?:eq|ne|lt|le|gt|ge|cmp|unord)sf2|__powisf2"
        r"|__fix(?:uns)?sf[sd]i|__float(?:un)?[sd]isf"
    ),
    has_operators=True,
)
DIVISION_64 = Family(
    "64-bit division", re.compile(r"__(?:u?div|u?mod|u?divmod)di[34]|__udivmoddi4"), has_operators=True
)
DIVISION_32 = Family("32-bit division", re.compile(r"__(?:u?div|u?mod|u?divmod)si[34]"), has_operators=True)
PRINTING = Family(
    "printing", re.compile(r"_{0,2}(?:[dfilms]_)?(?:v?(?:f|s|sn|d|as)?i?printf|puts|fputs|putchar|fputc|putc)(?:_r)?")
)

# Operators of C that become calls of routines with these letters in their names; others compare and convert.
OPERATORS = {"divmod": "[/%]", "mul": r"\*", "div": "/", "mod": "%", "add": r"\+", "sub": "-"}

FAMILIES = (DOUBLE_MATHS, FLOAT_MATHS, DOUBLE, FLOAT, DIVISION_64, DIVISION_32, PRINTING)


def family_of(name: str) -> Family | None:
    """Return the family of a routine; None of a function that is the program's, or the robots' library's."""
    return next((family for family in FAMILIES if family.has(name)), None)


def name_in_source(name: str) -> str:
    """Return the name by which a program calls a function of the C library: sin for _sin."""
    if family_of(name) in (DOUBLE_MATHS, FLOAT_MATHS):
        return re.sub("^__ieee754_|^__kernel_|^_+", "", name)
    if family_of(name) is PRINTING:
        return re.sub(r"^_{1,2}(?:[dfilms]_)?", "", name)
    return name


def pattern_in_source(name: str) -> str:
    """Return how code looks in C that calls a routine, as a pattern, by its name or an operator."""
    family = family_of(name)
    if family is None or not family.has_operators:
        return rf"\b{re.escape(name)}\s*\("
    return next((pattern for letters, pattern in OPERATORS.items() if letters in name), "[=<>(]")
