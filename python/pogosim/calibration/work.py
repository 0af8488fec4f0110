"""A whole calibration: reads tracks, fits, and reports."""

from __future__ import annotations

import argparse
import math
import shutil
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.rows import Runs
from pogosim.batch.runs.run_policy import RunPolicy
from pogosim.batch.workers.backends import Workers
from pogosim.calibration.fit import Fit, Matcher, Settings, fit, median_profile, tracker_errors
from pogosim.calibration.parameters import BIAS, chosen, start_bias, start_values
from pogosim.calibration.reading import read_track_table
from pogosim.calibration.result import as_json, bias_is_known, configuration_block, found_parameters, misfits
from pogosim.calibration.results import LINES, PICTURE, PROTOCOL, RESULT
from pogosim.calibration.rounding import in_words, noticed, rounding_noise, with_random_digits, with_steps
from pogosim.calibration.scene_of_tracks import Scene, handedness, in_arena, read_scene, start_poses, tracked_category
from pogosim.calibration.simulation import Simulator
from pogosim.calibration.statistics import check_motion, noise_bounds, statistics_of, tracker_noise
from pogosim.calibration.tracks import Tracks, continuous, cut, frame_numbers, on_grid
from pogosim.calibration.units import (
    UnitOptions,
    in_millimetres,
    in_radians,
    with_headings,
    y_down,
)
from pogosim.command.parser import warn
from pogosim.command.run import program_of
from pogosim.installation import find_installation
from pogosim.lines import say
from pogosim.outputs import partial_output, real_output, results_folder

NEED_HEADINGS = ("angular_noise_stddev", BIAS)


@dataclass(frozen=True)
class Prepared:
    """Tracks that are ready to be compared with.

    Attributes:
        tracks: In mm and rad, with headings.
        noise: First guess of the errors of the tracker in mm and rad, without those of rounding.
        facts: What was said of them.
    """

    tracks: Tracks
    noise: tuple[float, float]
    facts: list[str]


def prepare(prog: str, options: argparse.Namespace, scene: Scene) -> Prepared:
    """Read tracks, and say how they are understood.

    Raises:
        CalibrationError: They cannot be used.
        OSError: They cannot be read.
    """
    facts: list[str] = []

    def tell(text: str) -> None:
        facts.append(text)
        say(text)

    def caution(text: str) -> None:
        warn(prog, text)

    table = read_track_table(Path(options.tracks), scene.category, caution)
    tracks = with_steps(on_grid(table, *frame_numbers(table, options.fps, caution), caution))
    robots = f"{tracks.robots} robot{'' if tracks.robots == 1 else 's'}"
    tell(f"tracks: {robots}, {tracks.length_s:.4g} s, {1.0 / tracks.frame_s:.4g} frames/s")
    unit_options = UnitOptions(options.length_unit, options.mm_per_pixel, options.angle_unit, options.y_up)
    tracks = in_millimetres(tracks, table.units.get("x"), unit_options, scene.size_mm, tell, caution)
    tracks = cut(tracks, scene.radius_mm, caution)
    tracks = in_radians(tracks, table.units.get("angle"), unit_options, tell, caution)
    tracks = noticed(in_arena(continuous(y_down(tracks, unit_options, scene.size_mm[1], tell)), scene, caution))
    if steps := in_words(tracks):
        tell(f"rounded: {steps}; simulated tracks are rounded like them")
    tracks = with_random_digits(tracks, np.random.default_rng(options.seed))
    noise = tracker_noise(tracks)
    check_motion(tracks, noise[0])
    # Robots at rest show the random digits alone.
    own = [
        math.sqrt(max(of_all**2 - of_steps**2, 0.0))
        for of_all, of_steps in zip(noise, rounding_noise(tracks), strict=True)
    ]
    return Prepared(with_headings(tracks, noise[0]), (own[0], own[1]), facts)


def compiled(what: str | None, temporary: Path) -> Path:
    """Return the program that the robots ran.

    Raises:
        ToolError: There is none.
    """
    source = Path(what) if what else Path(shutil.copy(PROTOCOL, temporary / "protocol.c"))
    return program_of(source, find_installation())


def calibrate(prog: str, options: argparse.Namespace) -> None:
    """Fit, print, and write if a folder is given."""
    free, configuration = chosen(options.parameters), Configuration(options.config)
    entries = configuration.resolved()
    category = tracked_category(entries, configuration.path, options.category)
    if options.output_dir is not None:
        results_folder(Path(options.output_dir), (RESULT, LINES, PICTURE), [options.tracks, options.config])
    with tempfile.TemporaryDirectory(prefix="pogosim-calibrate-") as folder:
        program = compiled(options.simulator_binary, Path(folder))
        runs = Runs(
            configuration,
            str(program),
            folder,
            folder,
            Workers(number=options.workers),
            RunPolicy(retries=0, is_isolated=options.isolated),
        )
        with runs.opened():
            scene = read_scene(runs, entries, category)
            prepared = prepare(prog, options, scene)
            poses = start_poses(prepared.tracks, scene, lambda text: warn(prog, text))
            simulator = Simulator(runs, entries, category, scene.time_step_s, poses, prepared.tracks)
            if not prepared.tracks.has_angles and options.parameters is None:
                free = [name for name in free if name not in NEED_HEADINGS]
                warn(prog, f"without angles, {' and '.join(NEED_HEADINGS)} are not fitted (--parameters to try)")
            start, bias = start_values(scene.settings), start_bias(scene.settings)
            settings = Settings(free, start, bias, options.seed, options.runs, noise_bounds(prepared.tracks))
            matcher = Matcher(simulator, statistics_of(prepared.tracks), settings)
            progress = say if sys.stdout is not None and sys.stdout.isatty() else (lambda _text: None)
            fitted = fit(matcher, prepared.noise, progress)
    report(prog, options, scene, prepared, matcher, fitted)


def report(
    prog: str, options: argparse.Namespace, scene: Scene, prepared: Prepared, matcher: Matcher, fitted: Fit
) -> None:
    """Print the result and the doubts about it, and write it if a folder is given."""
    settings, (of_position, of_angle) = matcher.settings, tracker_errors(fitted.values, fitted.tracks)
    found = found_parameters(fitted, settings.start)
    with_bias = BIAS in settings.free
    and_angle = f", {of_angle:.2g} rad" if of_angle else ""
    say(f"noise of the tracker: {of_position:.2g} mm{and_angle}")
    side = handedness(median_profile(prepared.tracks), median_profile(fitted.tracks), fitted.tracks.frame_s)
    say_what_is_doubtful(prog, side, with_bias and bias_is_known(fitted))
    for line in misfits(matcher.measured, fitted):
        warn(prog, f"the simulation does not reproduce the {line} (another program, or pushes that it does not know?)")
    block = configuration_block(scene.category, found, fitted, with_bias)
    say("")
    say(*block.split("\n"))
    if options.output_dir is None:
        return
    from pogosim.calibration.figure import picture

    facts = {
        "tracks": Path(options.tracks).name,
        "program": Path(options.simulator_binary).name if options.simulator_binary else PROTOCOL.name,
        "seed": settings.seed,
        "runs": settings.runs,
        "robots": prepared.tracks.robots,
        "length_s": prepared.tracks.length_s,
        "understood": prepared.facts,
        "turns": side,
    }
    content = {
        RESULT: as_json(scene.category, found, fitted, matcher.measured, facts).encode(),
        LINES: (block + "\n").encode(),
        PICTURE: picture(prepared.tracks, fitted.tracks),
    }
    for name, data in content.items():
        with partial_output(real_output(Path(options.output_dir) / name)) as partial:
            partial.write_bytes(data)
    say("")
    say(f"written to {options.output_dir}: {', '.join(content)}")


def say_what_is_doubtful(prog: str, side: str, bias: bool) -> None:
    """Say whether tracks may be mirrored, which changes the sign of the bias."""
    if side == "mirrored":
        warn(prog, "the robots turn to the other side than the program says: is the film mirrored, or y up (--y-up)?")
    elif side == "unknown" and bias:
        say("the sign of the bias: as that of the angles; a mirrored film cannot be told with this program")
    elif bias:
        say("turns: to the same side as in the program, so the tracks are not mirrored")
