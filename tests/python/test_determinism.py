"""Same program, configuration and seed: the same bytes."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from running import ROOT, Run, example, run_command

# Every source of chance: noise of motors, sensors and clocks, losses of messages, placement.
NOISE = {
    "linear_noise_stddev": 0.1,
    "angular_noise_stddev": 0.5,
    "angular_systematic_bias_domain": "[-50, 50]",
    "photosensors_noise_stddev": 10,
    "photosensors_systematic_bias_domain": "[-20, 20]",
    "temporal_noise_stddev": 500,
}
SETTINGS = ["simulation_time=12", "objects.robots.nb=40", "arena_surface=4e5"]
EXAMPLES = ["run_and_tumble", "hanabi"]


def run_in_new_folder(name: str, folder: Path, *arguments: str) -> Run:
    folder.mkdir()
    shutil.copy(ROOT / "conf" / "simple.yaml", folder)
    command = ["-c", "simple.yaml", "-g", *arguments]
    if name == "hanabi":  # the file's parameters are those of run_and_tumble
        command += ["--set", "parameters={moving_robots: true}"]
    for setting in SETTINGS + [f"objects.robots.{key}={value}" for key, value in NOISE.items()]:
        command += ["--set", setting]
    result = run_command(example(name), folder, command)
    assert (result.code, result.errors if "-P" not in arguments else "") == (0, "")
    return result


def data(result: Run) -> bytes:
    return (result.folder / "frames" / "data.feather").read_bytes()


@pytest.mark.parametrize("name", EXAMPLES)
def test_equal_seeds_give_equal_bytes_in_another_folder_and_with_other_messages(name: str, tmp_path: Path) -> None:
    first = run_in_new_folder(name, tmp_path / "first")
    assert len(first.frame("frames/data.feather")) >= 11 * 40
    for number, flags in enumerate([[], ["-P"], ["-q"], ["-v"], ["-nr"], ["-s", "0"]]):
        assert data(run_in_new_folder(name, tmp_path / str(number), *flags)) == data(first), flags


@pytest.mark.parametrize("name", EXAMPLES)
def test_another_seed_gives_another_run(name: str, tmp_path: Path) -> None:
    frames = [
        run_in_new_folder(name, tmp_path / seed, "-s", seed).frame("frames/data.feather") for seed in ("0", "1", "2")
    ]
    for one, other in ((0, 1), (1, 2), (0, 2)):
        assert not frames[one]["x"].equals(frames[other]["x"])
        assert not frames[one]["pogobot_ticks"].equals(frames[other]["pogobot_ticks"])


@pytest.mark.parametrize("name", EXAMPLES)
def test_console_file_is_the_same_but_for_its_dates(name: str, tmp_path: Path) -> None:
    def lines(folder: str) -> list[str]:
        run_in_new_folder(name, tmp_path / folder)
        text = (tmp_path / folder / "frames" / "console.txt").read_text()
        return [line.split("] ", 1)[1] for line in text.splitlines()]

    assert lines("a") == lines("b")
