"""The result of a calibration: in words, as lines for a configuration, and as JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pogosim.calibration.fit import ALIKE, DAMPINGS, Fit, tracker_errors
from pogosim.calibration.identifiability import Verdict, verdicts, weakest_direction
from pogosim.calibration.parameters import ALL, BIAS, NOISES, PARAMETERS, TRACKER
from pogosim.calibration.statistics import Statistics
from pogosim.calibration.tracks import Floats
from pogosim.yaml_1_2 import dump_yaml

MISFIT_ERRORS, MISFIT_SHARE = 4.0, 0.1


TOO_SMALL = "too small to be seen beside the noise of the tracker"


@dataclass(frozen=True)
class Found:
    """A parameter of the result.

    Attributes:
        key: In the configuration.
        value: Fitted, or as it was.
        error: Standard error; inf: unknown.
        is_fitted: The value comes from the tracks.
        remark: Why it is not, or what is doubtful; may be empty.
    """

    key: str
    value: float
    error: float
    is_fitted: bool
    remark: str = ""


def judged(fitted: Fit) -> dict[str, Verdict]:
    """Judge fitted parameters among themselves, and each other one beside all fitted ones."""
    own = [name for name in fitted.names if name not in fitted.unfitted]
    columns = {name: fitted.sensitivity[:, place] for place, name in enumerate(fitted.names)}
    found = verdicts(np.column_stack([columns[name] for name in own]), own)
    for name in fitted.unfitted:
        together = [*own, name]
        found[name] = verdicts(np.column_stack([columns[other] for other in together]), together)[name]
    return found


def found_parameters(fitted: Fit, start: Mapping[str, float]) -> list[Found]:
    """Return what was found of each parameter that was looked at, except the bias."""
    judgement = judged(fitted)
    return [found_parameter(key, fitted, start, judgement[key]) for key in PARAMETERS if key in fitted.names]


def found_parameter(key: str, fitted: Fit, start: Mapping[str, float], verdict: Verdict) -> Found:
    """Return what was found of one parameter."""
    value = fitted.values[key]
    if key in NOISES and value <= 1.5 * ALL[key].least:
        return Found(key, 0.0, math.inf, False, TOO_SMALL)
    if key in fitted.unfitted:
        return Found(key, start[key], math.inf, False, unfitted_words(key, verdict))
    error = verdict.error * (value if ALL[key].is_logarithmic else ALL[key].value(1.0))
    if key in NOISES and not verdict.has_effect:
        return Found(key, 0.0, math.inf, False, TOO_SMALL)
    if not verdict.has_effect:
        return Found(key, start[key], math.inf, False, "has no effect on these tracks; as it was")
    remark = ""
    if not verdict.is_identified:
        remark = (
            f"cannot be told from {' and '.join(verdict.like[:2]) or 'the noise of the tracker'}; do not rely on it"
        )
    elif value <= ALL[key].least or value >= ALL[key].most:
        remark = "at the limit of the search"
    return Found(key, value, error, True, remark)


def unfitted_words(key: str, verdict: Verdict) -> str:
    """Say why a parameter was left as it was."""
    if verdict.has_effect and key in DAMPINGS:
        return f"cannot be told from {ALIKE[key]}, since the motors set the velocity at each tick; as it was"
    return "has no effect on these tracks; as it was"


def bias_words(fitted: Fit) -> str:
    """Say how well the range of the bias is known."""
    known = fitted.bias_by_robot[np.isfinite(fitted.bias_by_robot)]
    if len(known) == 0:
        return "not seen; as it was"
    low, high = fitted.bias
    if len(known) == 1:
        return "of one robot, which says nothing of others"
    text = f"of {len(known)} robots, +- {fitted.bias_error:.2g} each"
    if low == high:
        return f"{text}: robots do not differ"
    return text


def bias_is_known(fitted: Fit) -> bool:
    """Tell whether the bias was seen in the tracks."""
    return bool(np.isfinite(fitted.bias_by_robot).any())


def rounded(value: float, error: float) -> float:
    """Return a value with the digits that its error leaves, and one more; four without an error."""
    if value == 0.0:
        return 0.0
    digits = 4
    if math.isfinite(error) and error > 0.0:
        digits = max(2, min(6, 2 + math.floor(math.log10(abs(value))) - math.floor(math.log10(error))))
    return float(f"{value:.{digits}g}")


def configuration_block(category: str, found: Sequence[Found], fitted: Fit, bias: bool) -> str:
    """Return lines to paste into a configuration."""
    lines = ["objects:", f"    {dump_yaml(category).strip()}:"]
    for own in found:
        error = f", +- {own.error:.2g}" if math.isfinite(own.error) else ""
        remark = f"; {own.remark}" if own.remark else ""
        value = f"{own.key}: {rounded(own.value, own.error):g}"
        lines.append(f"        {value:40}  # {PARAMETERS[own.key].unit}{error}{remark}")
    if bias:
        value = f"{BIAS}: [{fitted.bias[0]}, {fitted.bias[1]}]"
        lines.append(f"        {value:40}  # motor power units; {bias_words(fitted)}")
    return "\n".join(lines)


def misfits(measured: Statistics, fitted: Fit) -> list[str]:
    """Say which statistics the simulation does not reproduce."""
    logarithms, _ = measured.logarithms()
    lines = []
    for name, own, simulated, error in zip(measured.names, logarithms, fitted.statistics, fitted.error, strict=True):
        difference = abs(own - simulated)
        if np.isfinite(difference) and difference > max(MISFIT_ERRORS * error, MISFIT_SHARE):
            lines.append(f"{name}: {math.exp(own):.3g} measured, {math.exp(simulated):.3g} simulated")
    return lines


def as_json(
    category: str,
    found: Sequence[Found],
    fitted: Fit,
    measured: Statistics,
    facts: Mapping[str, Any],
) -> str:
    """Return the content of the file of results."""
    logarithms, _ = measured.logarithms()
    judgement = judged(fitted)
    own = [name for name in fitted.names if name not in fitted.unfitted]
    columns = [fitted.names.index(name) for name in own]
    singular, direction = weakest_direction(fitted.sensitivity[:, columns], own)
    content = {
        **facts,
        "category": category,
        "parameters": {
            item.key: {
                "value": rounded(item.value, item.error),
                "unit": PARAMETERS[item.key].unit,
                "standard_error": number_or_none(item.error),
                "fitted": item.is_fitted,
                "remark": item.remark,
                "effect": judgement[item.key].effect,
                "own_share": judgement[item.key].own_share,
                "like": judgement[item.key].like,
            }
            for item in found
        },
        BIAS: {
            "value": list(fitted.bias),
            "by_robot": [number_or_none(value) for value in fitted.bias_by_robot],
            "standard_error": number_or_none(fitted.bias_error),
        },
        "tracker": dict(zip(TRACKER, tracker_errors(fitted.values, fitted.tracks), strict=True)),
        "weakest_direction": {"singular_value": singular, "parts": direction},
        "statistics": {
            name: {"measured": exponential(a), "simulated": exponential(b), "relative_error": float(error)}
            for name, a, b, error in zip(measured.names, logarithms, fitted.statistics, fitted.error, strict=True)
        },
    }
    return json.dumps(content, indent=2) + "\n"


def number_or_none(value: float | np.float64) -> float | None:
    """Return a number as JSON has it."""
    return float(value) if math.isfinite(value) else None


def exponential(logarithm: float | Floats) -> float | None:
    """Return a statistic from its logarithm; None if there is none."""
    return number_or_none(float(np.exp(logarithm)))
