"""Expressions of values of robots, such as "speed < 1 and heard > 10", for arrays of all robots of all runs.

The grammar is that of the window's breakpoints (`view.pause_when`). Operators, lowest precedence first: or; and; not;
< <= > >= == != (one of them); + -; * /; unary minus. Operands: numbers, names, abs(x), brackets. Truth values are 1 and
0; a comparison with a value that is not there (NaN) is false.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.nearest_name import advice
from pogosim.simulation.errors import ConfigurationError

Array = npt.NDArray[np.float32]
Read = Callable[[str], npt.NDArray[Any]]  # a value of all robots by its name
Term = Callable[[Read], Any]

DEEPEST = 100  # brackets within brackets
MOST_CHARACTERS = 1000
NUMBER = re.compile(r"(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
WORD = re.compile(r"\w")


def truth(value: Any) -> Any:
    """Return 1 where a value is neither 0 nor missing."""
    return ((value != 0) & ~np.isnan(value)).astype(np.float32)


def compared(compare: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    """Return a comparison whose truth values are numbers."""
    return lambda a, b: np.asarray(compare(a, b)).astype(np.float32)


def divided(a: Any, b: Any) -> Any:
    """Return a quotient, as C has it: infinite or NaN if the divisor is 0."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.divide(a, b)


Operators = dict[str, Callable[[Any, Any], Any]]

# Lowest precedence first. A sign that is the beginning of another one comes after it.
OR: Operators = {"or": lambda a, b: np.maximum(truth(a), truth(b))}
AND: Operators = {"and": lambda a, b: np.minimum(truth(a), truth(b))}
COMPARISONS: Operators = {
    "<=": compared(lambda a, b: a <= b),
    ">=": compared(lambda a, b: a >= b),
    "==": compared(lambda a, b: a == b),
    "!=": compared(lambda a, b: (a < b) | (a > b)),
    "<": compared(lambda a, b: a < b),
    ">": compared(lambda a, b: a > b),
}
SUMS: Operators = {"+": lambda a, b: a + b, "-": lambda a, b: a - b}
PRODUCTS: Operators = {"*": lambda a, b: a * b, "/": divided}


def binary(operation: Callable[[Any, Any], Any], a: Term, b: Term) -> Term:
    """Return an operation on two terms."""
    return lambda read: operation(a(read), b(read))


def unary(operation: Callable[[Any], Any], a: Term) -> Term:
    """Return an operation on one term."""
    return lambda read: operation(a(read))


class Parser:
    """Recursive descent: a method for each precedence."""

    def __init__(self, what: str, text: str, known: Sequence[str]) -> None:
        self.names: list[str] = []
        self._what = what
        self._text = text
        self._known = sorted(known, key=len, reverse=True)
        self._at = 0
        self._depth = 0

    def whole(self) -> Term:
        """Return all of the text."""
        if len(self._text) > MOST_CHARACTERS:
            raise ConfigurationError(
                f"{self._what}: an expression has at most {MOST_CHARACTERS} characters, found {len(self._text)}"
            )
        try:
            term = self._disjunction()
        except RecursionError:
            raise self._wrong("there are too many brackets") from None
        if self._skip_blanks() < len(self._text):
            raise self._wrong("expected 'and', 'or', an operator or the end")
        return term

    def _disjunction(self) -> Term:
        return self._chain(OR, self._conjunction)

    def _conjunction(self) -> Term:
        return self._chain(AND, self._negation)

    def _negation(self) -> Term:
        if self._take(("not",)):
            return unary(lambda a: np.float32(1) - truth(a), self._deeper(self._negation))
        return self._comparison()

    def _comparison(self) -> Term:
        left = self._sum()
        if sign := self._take(COMPARISONS):
            return binary(COMPARISONS[sign], left, self._sum())
        return left

    def _sum(self) -> Term:
        return self._chain(SUMS, self._product)

    def _product(self) -> Term:
        return self._chain(PRODUCTS, self._factor)

    def _factor(self) -> Term:
        if self._take(("-",)):
            return unary(np.negative, self._deeper(self._factor))
        if self._take(("(",)):
            return self._bracket()
        before = self._at
        if self._take(("abs",)):
            if self._take(("(",)):
                return unary(np.abs, self._bracket())
            self._at = before  # a value of that name
        if found := NUMBER.match(self._text, self._skip_blanks()):
            self._at = found.end()
            constant = np.float32(found[0])
            return lambda _read: constant
        return self._value()

    def _bracket(self) -> Term:
        inner = self._deeper(self._disjunction)
        if not self._take((")",)):
            raise self._wrong("expected ')'")
        return inner

    def _value(self) -> Term:
        """Names of columns may have any characters: the longest known name that stands here."""
        name = next((name for name in self._known if self._stands_here(name)), None)
        if name is None:
            found = re.compile(r"[\w.]*").match(self._text, self._at)
            word = found[0] if found else ""
            raise self._wrong(
                f"there is no value '{word}'{advice(word, sorted(self._known))}"
                if word
                else "expected a value or a number"
            )
        self._at += len(name)
        if name not in self.names:
            self.names.append(name)
        return lambda read: read(name).astype(np.float32)

    def _chain(self, operators: Operators, part: Callable[[], Term]) -> Term:
        left = part()
        while sign := self._take(operators):
            left = binary(operators[sign], left, part())
        return left

    def _deeper(self, part: Callable[[], Term]) -> Term:
        self._depth += 1
        if self._depth > DEEPEST:
            raise self._wrong("there are too many brackets")
        term = part()
        self._depth -= 1
        return term

    def _take(self, signs: Iterable[str]) -> str | None:
        """Go on behind one of these signs or words, if it stands here, and return it."""
        self._skip_blanks()
        sign = next((sign for sign in signs if self._stands_here(sign)), None)
        if sign is not None:
            self._at += len(sign)
        return sign

    def _stands_here(self, sign: str) -> bool:
        """Tell whether a sign stands here; a word must end where it does."""
        end = self._at + len(sign)
        goes_on = bool(WORD.match(sign[-1])) and bool(WORD.match(self._text[end : end + 1]))
        return self._text.startswith(sign, self._at) and not goes_on

    def _skip_blanks(self) -> int:
        while self._at < len(self._text) and self._text[self._at].isspace():
            self._at += 1
        return self._at

    def _wrong(self, why: str) -> ConfigurationError:
        return ConfigurationError(f"{self._what}: {self._text!r}, character {self._at + 1}: {why}")


class Expression:
    """A text that stands for a number of each robot.

    Attributes:
        text: It.
        names: The values in it, each once.
    """

    def __init__(self, what: str, text: str, known: Sequence[str]) -> None:
        """Read it.

        Args:
            what: The argument that it is from, for messages.
            text: At most `MOST_CHARACTERS`.
            known: Names of values.

        Raises:
            ConfigurationError: It cannot be read, or names a value that does not exist; says where.
        """
        parser = Parser(what, text, known)
        self.text = text
        self._term = parser.whole()
        self.names = tuple(parser.names)

    def numbers(self, read: Read) -> Array:
        """Return its value for all robots, of the shape that `read` gives (one number if it names no value)."""
        with np.errstate(over="ignore", invalid="ignore"):
            return np.asarray(self._term(read), dtype=np.float32)

    def is_true(self, read: Read) -> npt.NDArray[np.bool_]:
        """Return where it is true: neither 0 nor NaN."""
        return np.asarray(truth(self.numbers(read)), dtype=np.bool_)
