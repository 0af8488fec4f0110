"""What tracks are compared by: speeds, turn rates, and jitter, each a number for every robot.

Jitter is the size of second differences over a lag, |r(t + lag) - 2 r(t) + r(t - lag)|: uniform motion drops out of it.
For a tracker with independent errors of standard deviation s, its mean square is 6 s^2 at any lag, while the random
walk that the noise of motors causes adds 2 q lag, where q t is the variance of the walk. So short lags show the
tracker, and long ones the motors (its mean square at lag 0 and its slope, as in X. Michalet, "Mean square
displacement analysis of single-particle trajectories with localization error", Phys. Rev. E 82, 041914, 2010). A low
quantile keeps to the times between changes of what the robot does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pogosim.calibration.parameters import NOISES
from pogosim.calibration.tracks import Floats, Ints, Tracks
from pogosim.errors import CalibrationError

WINDOW_S = 0.4  # over which speeds and turn rates are taken
LAGS_S = (0.04, 0.08, 0.16, 0.32, 0.64, 1.0)  # of jitter
POSITION_JITTER = 0.25  # quantile
ANGLE_JITTER = 0.4
FAST = 0.9  # quantile of the speed: of robots that drive straight on, if they do so for a tenth of the time or more
TURNS = (0.05, 0.95)  # quantiles of the turn rate
# Relative errors of a statistic that its scatter does not show. MIXED: it depends on how often robots do what, and
# tracks may begin and end in the middle of a phase.
CERTAIN, MIXED = 0.005, 0.03
MOTOR_HZ = 60.0
MM_S_OF_LINEAR_NOISE = 100.0  # linear_noise_stddev is in units of it
# What jitter cannot be below, nearly that of the least noise that is fitted. Without noise and errors of a tracker,
# second differences are those of the last digits of the numbers, and their logarithms would outweigh all speeds.
RESOLUTION_MM, RESOLUTION_RAD = 0.02, 2e-4
LEAST_SAMPLES = 10
LEAST_MOTION_MM = 0.5
LEAST_MOTION_ERRORS = 4.0  # of the tracker; robots that stand seem to cover three at times
LINEAR, ANGULAR = "max_linear_speed", "max_angular_speed"

# Quantiles for a standard deviation of 1: of the length of a Gaussian vector in the plane, and of a number's size.
RAYLEIGH_QUANTILE = math.sqrt(-2.0 * math.log(1.0 - POSITION_JITTER))
HALF_NORMAL_QUANTILE = 0.5244
SECOND_DIFFERENCE = math.sqrt(6.0)


@dataclass(frozen=True)
class Statistics:
    """Statistics of tracks.

    Attributes:
        names: What each is: "speed, fastest tenth (mm/s)".
        about: Key of the noise that a statistic shows, which spoils a fit with wrong noise; LINEAR: none in particular.
        floor: Relative error of each that is always assumed. Shape (statistics,).
        by_robot: Shape (statistics, robots); NaN where a robot was not seen long enough.
        bias: Median turn rate of each robot in rad/s, which shows its bias. Shape (robots,).
    """

    names: tuple[str, ...]
    about: tuple[str, ...]
    floor: Floats
    by_robot: Floats
    bias: Floats

    def logarithms(self) -> tuple[Floats, Floats]:
        """Return the logarithm of the mean over robots of each statistic, and its standard error without the floor."""
        counted = np.maximum(np.isfinite(self.by_robot).sum(axis=1), 1)
        mean = np.nansum(self.by_robot, axis=1) / counted
        deviation = np.where(np.isfinite(self.by_robot), self.by_robot - mean[:, None], 0.0)
        with np.errstate(invalid="ignore", divide="ignore"):
            spread = np.sqrt(np.sum(deviation**2, axis=1) / np.maximum(counted - 1, 1))
            error = np.where(counted > 1, spread / np.sqrt(counted) / mean, 0.1)
            return np.log(mean), error


def difference(values: Floats, piece: Ints, lag: int) -> Floats:
    """Return values less those a number of frames before, NaN across pieces. Shape (frames - lag, robots, ...)."""
    same = (piece[lag:] == piece[:-lag]) & (piece[lag:] >= 0)
    return np.where(same.reshape(same.shape + (1,) * (values.ndim - 2)), values[lag:] - values[:-lag], np.nan)


def second_difference(values: Floats, piece: Ints, lag: int) -> Floats:
    """Return second differences over a number of frames. Shape (frames - 2 lag, robots, ...)."""
    first = difference(values, piece, lag)
    return np.asarray(first[lag:] - first[:-lag])


def quantile(values: Floats, share: float) -> Floats:
    """Return a quantile over frames for each robot, NaN if there are few. Shape (robots,)."""
    ordered = np.sort(values, axis=0)  # NaN last
    counted = np.isfinite(values).sum(axis=0)
    place = share * np.maximum(counted - 1, 0)
    low = np.floor(place).astype(int)
    high = np.minimum(low + 1, np.maximum(counted - 1, 0))
    columns = np.arange(values.shape[1])
    found = ordered[low, columns] * (1.0 - (place - low)) + ordered[high, columns] * (place - low)
    return np.where(counted >= LEAST_SAMPLES, found, np.nan)


def root_mean_square(values: Floats) -> Floats:
    """Return the root of the mean square over frames for each robot. Shape (robots,)."""
    counted = np.isfinite(values).sum(axis=0)
    total = np.nansum(values**2, axis=0)
    return np.where(counted >= LEAST_SAMPLES, np.sqrt(total / np.maximum(counted, 1)), np.nan)


def speeds(tracks: Tracks) -> Floats:
    """Return displacement over the window per time in mm/s. Shape (frames - window, robots)."""
    lag = tracks.frames_in(WINDOW_S)
    step = difference(tracks.position_mm, tracks.piece, lag)
    return np.asarray(np.hypot(step[..., 0], step[..., 1]) / (lag * tracks.frame_s))


def turn_rates(tracks: Tracks) -> Floats:
    """Return change of heading over the window per time in rad/s. Shape (frames - window, robots)."""
    lag = tracks.frames_in(WINDOW_S)
    return difference(tracks.angle_rad, tracks.piece, lag) / (lag * tracks.frame_s)


def lags(tracks: Tracks) -> list[int]:
    """Return the lags of jitter in frames, those that are different at this rate."""
    return sorted({tracks.frames_in(lag_s) for lag_s in LAGS_S})


def position_jitter(tracks: Tracks, lag: int) -> Floats:
    """Return a quantile of the second difference of the position of each robot, mm. Shape (robots,)."""
    second = second_difference(tracks.position_mm, tracks.piece, lag)
    return quantile(np.hypot(second[..., 0], second[..., 1]), POSITION_JITTER)


def angle_jitter(tracks: Tracks, lag: int) -> Floats:
    """Return a quantile of the second difference of the heading of each robot, rad. Shape (robots,)."""
    return quantile(np.abs(second_difference(tracks.angle_rad, tracks.piece, lag)), ANGLE_JITTER)


def jitter_error(jitter: Floats, resolution: float) -> float:
    """Return the relative error of jitter that its scatter does not show: large where it is hardly resolved."""
    known = jitter[np.isfinite(jitter)]
    return CERTAIN + float((resolution / known.mean()) ** 2) if len(known) else CERTAIN


def statistics_of(tracks: Tracks) -> Statistics:
    """Return the statistics of tracks, with headings where there are any."""
    speed, turning = speeds(tracks), turn_rates(tracks)
    middle = quantile(turning, 0.5)
    found: list[tuple[str, str, float, Floats]] = [
        ("speed, fastest tenth (mm/s)", "", CERTAIN, quantile(speed, FAST)),
        ("speed, root mean square (mm/s)", LINEAR, MIXED, root_mean_square(speed)),
        (
            "turn rate, half range (rad/s)",
            ANGULAR,
            CERTAIN,
            (quantile(turning, TURNS[1]) - quantile(turning, TURNS[0])) / 2.0,
        ),
        ("turn rate, root mean square around the median (rad/s)", ANGULAR, MIXED, root_mean_square(turning - middle)),
    ]
    for number, lag in enumerate(lags(tracks)):
        # From frame to frame, jitter is that of the tracker.
        linear, angular = NOISES if number else ("", "")
        over = f"over {lag * tracks.frame_s:.2g} s"
        jitter = np.hypot(position_jitter(tracks, lag), RESOLUTION_MM)
        found.append((f"jitter of the position {over} (mm)", linear, jitter_error(jitter, RESOLUTION_MM), jitter))
        if tracks.has_angles:
            jitter = np.hypot(angle_jitter(tracks, lag), RESOLUTION_RAD)
            found.append((f"jitter of the heading {over} (rad)", angular, jitter_error(jitter, RESOLUTION_RAD), jitter))
    return Statistics(
        names=tuple(item[0] for item in found),
        about=tuple(item[1] for item in found),
        floor=np.array([item[2] for item in found]),
        by_robot=np.array([np.where(item[3] > 0.0, item[3], np.nan) for item in found]),
        bias=middle,
    )


def tracker_noise(tracks: Tracks) -> tuple[float, float]:
    """Return a first guess of the errors of the tracker, from the jitter from frame to frame: an upper bound.

    Returns:
        Standard deviation of x and of y in mm, and of the heading in rad (NaN without headings).

    Raises:
        CalibrationError: Too little is seen.
    """
    if not np.isfinite(jitter := position_jitter(tracks, 1)).any():
        raise CalibrationError("no robot is seen in three frames in a row, often enough: too many gaps")
    position = float(np.nanmean(jitter)) / (RAYLEIGH_QUANTILE * SECOND_DIFFERENCE)
    angle = math.nan
    if tracks.has_angles and np.isfinite(own := angle_jitter(tracks, 1)).any():
        angle = float(np.nanmean(own)) / (HALF_NORMAL_QUANTILE * SECOND_DIFFERENCE)
    return position, angle


def noise_bounds(tracks: Tracks) -> dict[str, float]:
    """Return upper bounds of the noise of the motors, by key: with more, jitter over short lags would be larger.

    Noise of the velocity that is drawn anew MOTOR_HZ times a second makes a random walk.
    """
    jitters = [(NOISES[0], position_jitter, RAYLEIGH_QUANTILE * MM_S_OF_LINEAR_NOISE)]
    if tracks.has_angles:
        jitters.append((NOISES[1], angle_jitter, HALF_NORMAL_QUANTILE))
    bounds = {}
    for key, jitter_over, per_unit in jitters:
        walks = [
            float(np.mean(jitter[known])) / (per_unit * math.sqrt(2.0 * lag * tracks.frame_s / MOTOR_HZ))
            for lag in lags(tracks)
            if lag * tracks.frame_s <= WINDOW_S and (known := np.isfinite(jitter := jitter_over(tracks, lag))).any()
        ]
        if walks:
            bounds[key] = max(walks)
    return bounds


def check_motion(tracks: Tracks, noise_mm: float) -> None:
    """Raise CalibrationError if robots hardly move, or are not seen long enough to tell."""
    fast = quantile(speeds(tracks), FAST)
    if not np.isfinite(fast).any():
        raise CalibrationError(f"no robot is seen for {WINDOW_S:g} s without a gap, often enough to tell its speed")
    moved_mm = float(np.nanmax(fast)) * WINDOW_S
    if moved_mm < max(LEAST_MOTION_MM, LEAST_MOTION_ERRORS * noise_mm):
        raise CalibrationError(
            f"the robots hardly move: the fastest cover {moved_mm:.2g} mm in {WINDOW_S:g} s, and the errors of the "
            f"tracker are {noise_mm:.2g} mm; film robots that drive (--protocol), and check the unit of the tracks"
        )


def mean_square_displacement(tracks: Tracks, lags_s: Floats) -> Floats:
    """Return the mean squared displacement over lags, averaged over times and robots, mm2. Shape (lags,)."""
    values = []
    for lag_s in lags_s:
        lag = tracks.frames_in(float(lag_s))
        if lag >= len(tracks.piece):
            values.append(np.nan)
            continue
        step = difference(tracks.position_mm, tracks.piece, lag)
        square = np.sum(step**2, axis=-1)
        values.append(float(np.nanmean(square)) if np.isfinite(square).any() else np.nan)
    return np.array(values)
