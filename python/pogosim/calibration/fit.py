"""Fits the parameters of the motion: simulated statistics are brought to those of the tracks by Gauss-Newton steps.

In logarithms, speeds are proportional to the speed of the motors, and jitter to the noise that dominates it: the
statistics are nearly linear in the parameters, so that a few linear least squares replace a search (D. McFadden, "A
method of simulated moments", Econometrica 57(5), 1989; J. Nocedal, S. J. Wright, "Numerical Optimization", Springer,
2006, chapter 10). All candidates have the same seeds (common random numbers), so that differences are those of the
parameters.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from pogosim.calibration.identifiability import without_own_effect
from pogosim.calibration.parameters import ALL, BIAS, BIAS_LIMIT, NOISES, PARAMETERS, TRACKER
from pogosim.calibration.rounding import rounded, rounding_noise, with_random_digits
from pogosim.calibration.simulation import Bias, Candidate, Simulator
from pogosim.calibration.statistics import Statistics, quantile, statistics_of, turn_rates
from pogosim.calibration.tracks import Floats, Tracks
from pogosim.calibration.units import with_headings
from pogosim.errors import CalibrationError

BIAS_STEP = 40  # motor power units, to either side, to see what a bias does
LOG_STEP, STEP = 0.15, 1.0  # in scales of a parameter, to see what it does
# Dampings, and the speeds that they are like.
ALIKE = {"body_linear_damping": "max_linear_speed", "body_angular_damping": "max_angular_speed"}
DAMPINGS = tuple(ALIKE)
ITERATIONS = 6
JACOBIANS = (0, 1)  # iterations that look at the sensitivities again
RIDGE = 0.05  # of the normal equations: a parameter without effect stays where it is
LONGEST_STEP = 1.5
DONE = 0.01  # relative change

Report = Callable[[str], None]


@dataclass(frozen=True)
class Settings:
    """How to fit.

    Attributes:
        free: Keys to fit.
        start: Values of all keys at the start, which those that are not fitted keep.
        bias: Range of the bias at the start.
        seed: Seed of the first simulated run.
        runs: Simulated runs whose statistics are averaged.
        most: Values that the fit does not start above, by key.
    """

    free: Sequence[str]
    start: Mapping[str, float]
    bias: Bias = (0, 0)
    seed: int = 42
    runs: int = 3
    most: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Fit:
    """What was found.

    Attributes:
        values: Values of all keys, and tracker_noise_mm and tracker_noise_rad.
        bias: Range of the bias, motor power units.
        bias_by_robot: Bias of each robot that is seen in its median turn rate. Shape (robots,); empty: not looked for.
        bias_error: Standard error of one of them.
        sensitivity: Change of the statistics, in their standard errors, per scale of each of `names`, at the result.
        names: Parameters that were looked at: fitted ones, and those with no effect of their own.
        unfitted: Those with no effect of their own.
        statistics: Statistics of the simulated runs: logarithms; NaN where they were not compared. Shape (statistics,).
        error: Standard errors of the difference. Shape (statistics,).
        tracks: Simulated, with the noise of the tracker.
    """

    values: dict[str, float]
    bias: Bias
    bias_by_robot: Floats
    bias_error: float
    sensitivity: Floats
    names: tuple[str, ...]
    unfitted: tuple[str, ...]
    statistics: Floats
    error: Floats
    tracks: Tracks


@dataclass
class Matcher:
    """Simulates candidates, and compares what they do with what was tracked."""

    simulator: Simulator
    measured: Statistics
    settings: Settings
    runs: dict[Candidate, Tracks] = field(default_factory=dict)

    def candidate(self, values: Mapping[str, float], bias: Bias, run: int) -> Candidate:
        """Return the candidate of a run; the noise of the tracker is no part of it."""
        return Candidate.of({key: values[key] for key in PARAMETERS}, bias, self.settings.seed + run)

    def prepare(self, candidates: Sequence[Candidate]) -> None:
        """Run candidates that were not run yet, some at the same time."""
        todo = [candidate for candidate in dict.fromkeys(candidates) if candidate not in self.runs]
        for candidate, rows in zip(todo, self.simulator.simulate(todo), strict=True):
            self.runs[candidate] = self.simulator.seen(rows)

    def tracked(self, values: Mapping[str, float], bias: Bias, run: int) -> Tracks:
        """Return a simulated run as the tracker would see it, with its errors: the same draws in all candidates."""
        candidate = self.candidate(values, bias, run)
        self.prepare([candidate])
        clean = self.runs[candidate]
        draws = np.random.default_rng(candidate.seed)
        position = clean.position_mm + values["tracker_noise_mm"] * draws.standard_normal(clean.position_mm.shape)
        angle = clean.angle_rad
        if clean.has_angles:
            angle = angle + values["tracker_noise_rad"] * draws.standard_normal(angle.shape)
        seen = rounded(replace(clean, position_mm=position, angle_rad=angle))
        return with_headings(with_random_digits(seen, draws), tracker_errors(values, clean)[0])

    def logarithms(self, values: Mapping[str, float], bias: Bias, runs: Sequence[int]) -> tuple[Floats, Floats]:
        """Return the logarithms of simulated statistics, averaged over runs, and their standard errors."""
        self.prepare([self.candidate(values, bias, run) for run in runs])
        pairs = [statistics_of(self.tracked(values, bias, run)).logarithms() for run in runs]
        mean = np.mean([pair[0] for pair in pairs], axis=0)
        return mean, np.sqrt(np.mean([pair[1] ** 2 for pair in pairs], axis=0) / len(pairs))

    def sensitivity(self, values: Mapping[str, float], bias: Bias, names: Sequence[str]) -> Floats:
        """Return the change of the statistics per scale of parameters, by one run each. Shape (statistics, names)."""
        moved = {}
        for name in names:
            parameter = ALL[name]
            step = LOG_STEP if parameter.is_logarithmic else STEP
            moved[name] = {**values, name: parameter.value(parameter.coordinate(values[name]) + step)}
        self.prepare([self.candidate(own, bias, 0) for own in (values, *moved.values())])
        here = self.logarithms(values, bias, [0])[0]
        columns = []
        for name, own in moved.items():
            scale = LOG_STEP if ALL[name].is_logarithmic else STEP
            columns.append((self.logarithms(own, bias, [0])[0] - here) / scale)
        return np.nan_to_num(np.column_stack(columns))

    def comparable(self) -> npt.NDArray[np.bool_]:
        """Tell which statistics to fit: none of a parameter that stays as it is. Shape (statistics,)."""
        shown = {"", *self.settings.free, *(ALIKE[key] for key in DAMPINGS if key in self.settings.free)}
        return np.array([about in shown for about in self.measured.about])

    def biases(self, values: Mapping[str, float], runs: Sequence[int]) -> tuple[Floats, float]:
        """Return the bias of each tracked robot in motor power units, by interpolation between simulated ones.

        Returns:
            Shape (robots,), NaN of robots seen too briefly; and the standard error of one, from the scatter of
            simulated robots that all have the same bias.
        """
        pairs = [(domain, run) for domain in ((-BIAS_STEP,) * 2, (BIAS_STEP,) * 2) for run in runs]
        self.prepare([self.candidate(values, domain, run) for domain, run in pairs])
        rates: dict[int, list[Floats]] = {-BIAS_STEP: [], BIAS_STEP: []}
        for domain, run in pairs:
            rates[domain[0]].append(median_turn_rate(self.tracked(values, domain, run)))
        low, high = (float(np.nanmean(np.concatenate(rates[side]))) for side in (-BIAS_STEP, BIAS_STEP))
        slope = (high - low) / (2 * BIAS_STEP)
        known = [own[np.isfinite(own)] for side in rates.values() for own in side]
        variances = [np.var(own, ddof=1) for own in known if len(own) > 1]
        scatter = np.sqrt(np.mean(variances)) / max(abs(slope), 1e-9) if variances else np.nan
        if not np.isfinite(slope) or abs(slope) < 1e-9:
            return np.full(len(self.measured.bias), np.nan), np.inf
        return (self.measured.bias - (low + high) / 2.0) / slope, float(scatter)


def tracker_errors(values: Mapping[str, float], tracks: Tracks) -> tuple[float, float]:
    """Return the standard deviations of all errors of the tracker, with those of rounding, in mm and in rad."""
    of_position, of_angle = rounding_noise(tracks)
    return math.hypot(values["tracker_noise_mm"], of_position), math.hypot(values["tracker_noise_rad"], of_angle)


def median_turn_rate(tracks: Tracks) -> Floats:
    """Return the median turn rate of each robot, rad/s. Shape (robots,)."""
    return quantile(turn_rates(tracks), 0.5)


def median_profile(tracks: Tracks) -> Floats:
    """Return the turn rate over time, the median of the robots, rad/s; 0 where none is known. Shape (frames,)."""
    rates = turn_rates(tracks)
    known = np.isfinite(rates).any(axis=1)
    profile = np.zeros(len(rates))
    profile[known] = np.nanmedian(rates[known], axis=1)
    return profile


def bias_range(by_robot: Floats, error: float) -> Bias:
    """Return the range of a uniform distribution with these draws, each seen with an error.

    The range of n draws is (n - 1) / (n + 1) of that of the distribution on average (H. A. David, H. N. Nagaraja,
    "Order Statistics", Wiley, 2003, section 3.1). Where errors are not small, the variance is used instead, less that
    of the errors.
    """
    known = by_robot[np.isfinite(by_robot)]
    if len(known) == 0:
        return 0, 0
    if len(known) == 1:
        return whole_bias(known[0]), whole_bias(known[0])
    variance, n = float(np.var(known, ddof=1)), len(known)
    own = variance - error**2
    if own <= 2.0 * error**2 * np.sqrt(2.0 / (n - 1)):  # two standard errors of the variance
        return whole_bias(known.mean()), whole_bias(known.mean())
    if error**2 > 0.05 * variance:
        middle, half = float(known.mean()), float(np.sqrt(3.0 * own))
    else:
        middle, half = (known.max() + known.min()) / 2.0, (known.max() - known.min()) / 2.0 * (n + 1) / (n - 1)
    return whole_bias(middle - half), whole_bias(middle + half)


def whole_bias(value: float) -> int:
    """Return a bias as the configuration takes it."""
    return int(np.clip(round(float(value)), -BIAS_LIMIT, BIAS_LIMIT))


def first_values(settings: Settings, noise: tuple[float, float]) -> dict[str, float]:
    """Return where the fit starts: the configuration's values, noise above 0, and the noise of the tracker."""
    values = dict(settings.start)
    for key in settings.free:
        if key in PARAMETERS and PARAMETERS[key].is_logarithmic and values[key] <= PARAMETERS[key].least:
            values[key] = PARAMETERS[key].start
        if key in settings.most:
            values[key] = max(min(values[key], settings.most[key]), PARAMETERS[key].least)
    guesses = dict(zip(TRACKER, noise, strict=True))
    return values | {
        key: max(guesses[key], TRACKER[key].least) if np.isfinite(guesses[key]) else 0.0 for key in TRACKER
    }


def gauss_newton_step(sensitivity: Floats, residual: Floats, error: Floats) -> Floats:
    """Return the step of weighted least squares with a small ridge, no longer than LONGEST_STEP for any parameter."""
    weighted = sensitivity / error[:, None]
    normal = weighted.T @ weighted
    # The ridge is relative to the effect of a parameter, and absolute for those with none.
    normal += np.diag(1e-3 * np.diag(normal) + RIDGE)
    step = np.linalg.solve(normal, weighted.T @ (residual / error))
    return np.asarray(np.clip(step, -LONGEST_STEP, LONGEST_STEP))


def fit(matcher: Matcher, noise: tuple[float, float], report: Report) -> Fit:
    """Fit parameters.

    Args:
        matcher: The tracks, and how to simulate.
        noise: First guess of the noise of the tracker in mm and in rad (NaN: no headings), without that of rounding.
        report: Called with a line for each iteration.

    Raises:
        CalibrationError: The simulated robots show nothing that could be compared.
    """
    settings, (measured, own_error) = matcher.settings, matcher.measured.logarithms()
    usable = np.isfinite(measured) & matcher.comparable()
    values, bias = first_values(settings, noise), settings.bias
    trackers = [key for key in TRACKER if values[key] > 0.0]
    looked_at = [*trackers, *(key for key in PARAMETERS if key in settings.free)]
    free = list(looked_at)
    if not usable.any():
        raise CalibrationError(
            "the tracks show neither speeds nor turns: too short, too many gaps, or robots that stand"
        )
    by_robot, bias_error, sensitivity = np.zeros(0), np.inf, np.zeros((0, 0))
    best: tuple[float, dict[str, float], Bias] = (np.inf, values, bias)
    for iteration in range(ITERATIONS + 1):
        if BIAS in settings.free:
            by_robot, bias_error = matcher.biases(values, [0])
            bias = bias_range(by_robot, bias_error) if np.isfinite(by_robot).any() else bias
        runs = range(1 if iteration in JACOBIANS[:1] else settings.runs)
        simulated, error = total_error(matcher, values, bias, runs, own_error)
        both = usable & np.isfinite(simulated)
        residual = np.where(both, measured - simulated, 0.0)
        misfit = misfit_per_statistic(residual, error, both)
        report(f"iteration {iteration + 1}: misfit {misfit:.3g} per statistic")
        # The first iteration has fewer runs and larger errors: its misfit is no measure for the others.
        if misfit < best[0] or iteration == 1:
            best = (misfit, dict(values), bias)
        if iteration == ITERATIONS:
            break  # the last step has been looked at
        if iteration in JACOBIANS:
            names = looked_at if iteration == 0 else free
            sensitivity = matcher.sensitivity(values, bias, names)
            if iteration == 0:
                idle = without_own_effect((sensitivity / error[:, None])[both], names, DAMPINGS)
                free = [name for name in names if name not in idle]
                sensitivity = sensitivity[:, [names.index(name) for name in free]]
        step = gauss_newton_step(np.where(both[:, None], sensitivity, 0.0), residual, error)
        values |= {
            name: ALL[name].value(ALL[name].coordinate(values[name]) + change)
            for name, change in zip(free, step, strict=True)
        }
        if np.max(np.abs(step)) < DONE:
            break
    without = without_needless_noise(matcher, best, usable, own_error)
    return ended(matcher, without, best[2], looked_at, [name for name in looked_at if name not in free], own_error)


def misfit_per_statistic(residual: Floats, error: Floats, compared: npt.NDArray[np.bool_]) -> float:
    """Return the mean square of residuals, in their errors."""
    return float(np.sum((residual / error) ** 2)) / max(int(compared.sum()), 1)


def without_needless_noise(
    matcher: Matcher, best: tuple[float, dict[str, float], Bias], usable: npt.NDArray[np.bool_], own_error: Floats
) -> dict[str, float]:
    """Return the best values, without noise of motors where the tracks are reproduced as well without it.

    Noise far below that of the tracker changes the statistics by the square of its share: steps towards zero are small.
    """
    misfit, values, bias = best
    measured = matcher.measured.logarithms()[0]
    for key in NOISES:
        if key not in matcher.settings.free:
            continue
        own = {**values, key: ALL[key].least}
        simulated, error = total_error(matcher, own, bias, range(matcher.settings.runs), own_error)
        both = usable & np.isfinite(simulated)
        found = misfit_per_statistic(np.where(both, measured - simulated, 0.0), error, both)
        if found <= misfit:
            misfit, values = found, own
    return values


def total_error(
    matcher: Matcher, values: Mapping[str, float], bias: Bias, runs: Sequence[int], own_error: Floats
) -> tuple[Floats, Floats]:
    """Return simulated statistics, and the error of their difference to the measured ones."""
    simulated, error = matcher.logarithms(values, bias, runs)
    return simulated, np.sqrt(
        np.nan_to_num(error, nan=1.0) ** 2 + np.nan_to_num(own_error, nan=1.0) ** 2 + matcher.measured.floor**2
    )


def ended(
    matcher: Matcher, values: dict[str, float], bias: Bias, looked_at: list[str], unfitted: list[str], own_error: Floats
) -> Fit:
    """Look at the result: its sensitivities, and the bias by all runs."""
    every = range(matcher.settings.runs)
    by_robot, bias_error = np.zeros(0), np.inf
    if BIAS in matcher.settings.free:
        by_robot, bias_error = matcher.biases(values, every)
        bias = bias_range(by_robot, bias_error) if np.isfinite(by_robot).any() else bias
    simulated, error = total_error(matcher, values, bias, every, own_error)
    sensitivity = matcher.sensitivity(values, bias, looked_at)
    both = np.isfinite(simulated) & np.isfinite(matcher.measured.logarithms()[0]) & matcher.comparable()
    return Fit(
        values=values,
        bias=bias,
        bias_by_robot=by_robot,
        bias_error=bias_error,
        sensitivity=np.where(both[:, None], sensitivity / error[:, None], 0.0),
        names=tuple(looked_at),
        unfitted=tuple(unfitted),
        statistics=np.where(both, simulated, np.nan),
        error=error,
        tracks=matcher.tracked(values, bias, 0),
    )
