"""The command `pogosim export-policy`, and its example: a policy that drives robots in C, in firmware and in Python."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pogosim
import pytest
import yaml
from exported_policy import observe
from in_process import pogosim as command
from in_process import refusal
from pogosim.policy import Dense, Policy, network_of
from pogosim.policy.choices import NUMBERS
from project import CLEAN
from random_policies import ALL, random_network
from running import ROOT, Run, build_folder, compile_program, ran, run

EXAMPLE = ROOT / "examples" / "policy"
FILES = (str(EXAMPLE / "phototaxis.npz"), "--calibration", str(EXAMPLE / "observations.npz"))


ENVIRONMENT = CLEAN | {"POGOSIM_DIR": str(build_folder())}


def exported(folder: Path, *arguments: str) -> Run:
    """Export a policy in a process of its own, as measuring its cycles needs, with the simulator under test."""
    return ran(folder, sys.executable, "-m", "pogosim", "export-policy", *arguments, env=ENVIRONMENT, timeout=600)


def test_header_of_the_example_is_that_of_its_network(tmp_path: Path) -> None:
    result = exported(tmp_path, *FILES, "--numbers", "int16", "-o", "policy.h")
    assert (result.code, result.errors) == (0, "")
    assert (tmp_path / "policy.h").read_text() == (EXAMPLE / "policy.h").read_text(), "export it again"
    first, *lines = result.output.splitlines()
    assert first == "policy.h: 3 inputs, 6 tanh, 2 hardtanh; int16"
    assert [line.split()[0] for line in lines] == ["program", "memory", "multiplications", "accuracy", "cycles"]
    accuracy = re.search(r"within ([\d.]+) .* observations ([\d.]+) from floats on average, ([\d.]+) at most", lines[3])
    assert accuracy is not None
    bound, mean, most = map(float, accuracy.groups())
    assert mean <= most <= bound
    assert bound == 3.54  # one that is far larger would hold as well
    cycles = re.fullmatch(
        r"cycles           (\d+) per call on an emulated robot, [\d.]+ % of a tick at 60 Hz \(350000\): it fits",
        lines[4],
    )
    assert cycles is not None
    assert 2000 < int(cycles[1]) < 20000


def test_observations_beyond_the_range_of_the_inputs_are_told(tmp_path: Path) -> None:
    """The bound holds within the range alone, and observations of a policy with memory need not follow each other."""
    rows = np.full((5, 3), 1500)
    rows[1] = 3001
    for name, rows_given, said in (
        (
            "plain",
            rows,
            r"; in the 5 observations \S+ from floats on average, \S+ at most; 1 of 5 observations are beyond the "
            r"range of the inputs, and are cut to it\n",
        ),
        ("plain", rows[2:], r"; in the 3 observations \S+ from floats on average, \S+ at most\n"),
        ("gated", rows, r"of exact arithmetic, for a step from the same state\n"),
    ):
        Policy(random_network(ALL[name])).save(tmp_path / "a.npz")
        np.save(tmp_path / "o.npy", rows_given)
        options = ("-o", "a.h", "--numbers", "int16", "--calibration", "o.npy", "--no-cycles")
        result = command(tmp_path, "export-policy", "a.npz", *options)
        assert result.code == 0
        assert re.search(said, result.output), result.output


def test_full_standard_output_is_named(tmp_path: Path) -> None:
    Policy(random_network(ALL["plain"])).save(tmp_path / "a.npz")
    with Path("/dev/full").open("w") as full:
        arguments = [sys.executable, "-m", "pogosim", "export-policy", "a.npz", "-o", "a.h", "--no-cycles"]
        done = subprocess.run(
            arguments, cwd=tmp_path, env=ENVIRONMENT, stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 2
    said = "a.h is complete, but the standard output cannot be written: No space left on device"
    assert done.stderr == f"pogosim export-policy: {said}\n"
    assert (tmp_path / "a.h").exists()


def test_page_says_how_much_faster_whole_numbers_are() -> None:
    page = (ROOT / "docs" / "policy_export.md").read_text()
    assert "about ten times as fast or more" in " ".join(page.split())
    rows = re.findall(r"^\| (\d+ inputs, [^|]*) \| (\w+) \|.* \| (\d+) \| [\d.]+ % \|$", page, re.MULTILINE)
    cycles = {(policy, numbers): int(count) for policy, numbers, count in rows}
    ratios = [cycles[policy, "float"] / count for (policy, numbers), count in cycles.items() if numbers != "float"]
    assert len(ratios) == 4
    assert min(ratios) > 9.5


def test_floats_take_many_times_as_long_as_whole_numbers(tmp_path: Path) -> None:
    cycles = {}
    for numbers in ("float", "int8"):
        result = exported(tmp_path, *FILES, "--numbers", numbers, "-o", "policy.h")
        cycles[numbers] = int(re.search(r"cycles +(\d+) per call", result.output)[1])  # type: ignore[index]
    assert cycles["float"] > 10 * cycles["int8"]


def test_policy_that_takes_longer_than_a_tick_does_not_fit(tmp_path: Path) -> None:
    Policy(random_network([("gru", 20, ""), ("dense", 1, "tanh")])).save(tmp_path / "large.npz")
    result = exported(tmp_path, "large.npz", "-o", "large.h", "--name", "large")
    assert (result.code, result.errors) == (0, "")
    assert re.search(
        r"cycles +\d+ per call on an emulated robot, \d+ % of a tick at 60 Hz \(350000\): it does not fit",
        result.output,
    )


def test_policy_that_no_robot_has_room_for_is_warned_of(tmp_path: Path) -> None:
    Policy(random_network([("dense", 300, "tanh"), ("dense", 300, "tanh")])).save(tmp_path / "large.npz")
    result = command(tmp_path, "export-policy", "large.npz", "-o", "large.h", "--no-cycles")
    assert result.code == 0
    assert result.errors == "pogosim export-policy: warning: the policy does not fit into the 128 KiB of a robot\n"
    assert "cycles           not measured: --no-cycles" in result.output


@pytest.mark.parametrize("numbers", NUMBERS)
def test_policy_far_too_large_for_robots_is_refused_before_it_takes_long(numbers: str, tmp_path: Path) -> None:
    Policy(network_of([Dense(np.ones((4096, 4096)), np.zeros(4096), "tanh")])).save(tmp_path / "large.npz")
    line = refusal(command(tmp_path, "export-policy", "large.npz", "-o", "a.h", "--numbers", numbers))
    assert line == (
        "pogosim export-policy: the policy has 16777216 weights; expected 262144 at most, which are already more than "
        "the 128 KiB of a robot: train a smaller network"
    )


def test_pipes_and_devices_are_refused(tmp_path: Path) -> None:
    Policy(random_network(ALL["plain"])).save(tmp_path / "a.npz")
    for name in ("f.npz", "f.pt", "f.onnx", "f.npy", "f.csv"):
        os.mkfifo(tmp_path / name)
    options = ("-o", "a.h", "--no-cycles", "--numbers", "int8")
    for policy, name, more in (
        *((name, name, ()) for name in ("f.npz", "f.pt", "f.onnx")),
        *(("a.npz", name, ("--calibration", name)) for name in ("f.npz", "f.npy", "f.csv", "/dev/null")),
        ("a.npz", "f.npz", ("--scaling", "f.npz")),
    ):
        line = refusal(command(tmp_path, "export-policy", policy, *more, *options))
        assert line == (
            f"pogosim export-policy: {name} is not a file, but a pipe, a socket or a device; expected a file"
        )


def test_without_the_robots_compiler_cycles_are_not_measured(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.setenv("POGOSIM_DIR", str(build_folder()))
    result = command(tmp_path, "export-policy", *FILES, "-o", "policy.h")
    assert (result.code, result.errors) == (0, "")
    assert (
        "cycles           not measured: the compiler for robots, riscv64-unknown-elf-gcc, is not installed"
        in result.output
    )
    assert (tmp_path / "policy.h").exists()


def test_pt_and_onnx_files_are_scaled_and_named_by_another_file(tmp_path: Path) -> None:
    np.savez(
        tmp_path / "scaling.npz",
        input_names=["a", "b", "c"],
        input_scale=1e-3,
        input_low=-1000,
        input_high=1000,
        output_scale=1023,
    )
    made = ROOT / "tests" / "policies"
    common = ["--scaling", "scaling.npz", "--numbers", "int16", "--no-cycles", "-o"]
    for name, options in (
        ("plain.pt", ["--activation", "tanh"]),
        ("plain.onnx", []),
        ("gru.pt", ["--output-activation", "hardtanh"]),
    ):
        result = command(tmp_path, "export-policy", str(made / name), *options, *common, f"{name}.h")
        assert (result.code, result.errors) == (0, ""), result.text
    texts = [(tmp_path / f"{name}.h").read_text().split("#ifndef")[1] for name in ("plain.pt", "plain.onnx")]
    assert texts[0] == texts[1]
    assert "POLICY_INPUT_A,  // a: scaled by (a - 0) * 0.001, cut to -1000 to 1000" in texts[0]
    assert "policy_state_t" in (tmp_path / "gru.pt.h").read_text()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "expected a policy (.npz, .onnx, .pt) and -o FILE.h"),
        (["none.npz", "-o", "a.h"], "none.npz: no such file or directory"),
        (["a.npz", "-o", "a.c"], "a.c does not end in .h"),
        (["a.npz", "-o", "a.npz"], "a.npz would take the place of a.npz; name another output"),
        (["a.npz", "-o", "no/a.h"], "no/a.h cannot be written: there is no folder "),
        (["a.npz", "-o", "a.h", "--calibration", "a.h"], "a.h would take the place of a.h; name another output"),
        (["a.npz", "-o", "a.h", "--calibration", "none.npz"], "none.npz: no such file or directory"),
        (["a.npz", "-o", "a.h", "--calibration", "a.npz"], "a.npz has no array 'observations', but "),
        (["a.npz", "-o", "a.h", "--scaling", "a.npz"], "a.npz has an array 'layer0_"),
        (["a.npz", "-o", "a.h", "--name", "a b"], "--name a b: expected a name as in C"),
        (["a.npz", "-o", "a.h", "--activation", "tanh"], "a.npz says itself what its activations are"),
        (["a.csv", "-o", "a.h"], "a.csv does not end in .npz, .onnx, .pt or .pth; expected a policy"),
        (["b.npz", "-o", "a.h", "--numbers", "int8"], "the range of the input x0 is unknown; expected observations of"),
    ],
)
def test_wrong_use_is_one_line_and_writes_nothing(arguments: list[str], said: str, tmp_path: Path) -> None:
    Policy(random_network(ALL["plain"])).save(tmp_path / "a.npz")
    np.savez(tmp_path / "b.npz", layer0_weights=np.ones((1, 2)))
    (tmp_path / "a.csv").write_text("x")
    line = refusal(command(tmp_path, "export-policy", *arguments))
    assert line.startswith(f"pogosim export-policy: {said}")
    assert not (tmp_path / "a.h").exists()


def test_option_without_output_or_of_another_kind_is_told(tmp_path: Path) -> None:
    for arguments, said in (
        (["a.npz"], "the following arguments are required: -o/--output"),
        (["a.npz", "-o", "a.h", "--numbers", "int4"], "argument --numbers: invalid choice: 'int4'"),
    ):
        result = command(tmp_path, "export-policy", *arguments)
        assert result.code == 2
        assert said in result.errors


# ---- the example ----

SETTINGS: dict[str, object] = {"simulation_time": 8.0, "save_data_period": 0.1, "seed": 3}


def scene_of_example() -> dict[str, object]:
    """Return the objects of conf/policy.yaml, for a scene."""
    shipped = yaml.safe_load((ROOT / "conf" / "policy.yaml").read_text())
    return {**SETTINGS, "arena_surface": shipped["arena_surface"], "objects": shipped["objects"]}


def test_robots_of_the_example_gather_in_the_light(tmp_path: Path) -> None:
    program = compile_program(tmp_path / "policy", EXAMPLE / "main.c")
    result = run(program, tmp_path, scene_of_example())
    assert (result.code, result.errors) == (0, "")
    rows = result.frame()
    light = rows[rows["robot_category"] == "robots"].groupby("time")["light"].mean()
    assert light.iloc[-1] > 25_000 > 1.3 * light.iloc[5]


def test_host_moves_robots_as_a_program_does_that_is_a_tick_late(tmp_path: Path) -> None:
    """Bit for bit, where there is no noise: a program that drives by its last outputs sees what the host sees.

    With noise, the host's robots draw other numbers, since they read all their sensors.
    """
    text = (EXAMPLE / "main.c").read_text()
    text = text.replace("typedef struct {", "typedef struct {\n    policy_value_t last[POLICY_OUTPUTS];", 1)
    text = text.replace(
        "    observe();\n    policy_step(mydata->inputs, outputs);\n",
        "    memcpy(outputs, mydata->last, sizeof(outputs));\n"
        "    observe();\n    policy_step(mydata->inputs, mydata->last);\n",
    )
    assert text.count("last") == 3
    (tmp_path / "main.c").write_text(text)
    (tmp_path / "policy.h").write_text((EXAMPLE / "policy.h").read_text())
    program = compile_program(tmp_path / "late", tmp_path / "main.c")
    scene = scene_of_example()
    names = ("linear_noise_stddev", "angular_noise_stddev", "photosensors_noise_stddev")
    result = run(program, tmp_path, {**scene, **{f"objects.robots.{name}": 0.0 for name in names}})
    assert (result.code, result.errors) == (0, "")
    rows = result.frame()
    rows = rows[rows["robot_category"] == "robots"].sort_values(["time", "robot_id"])

    policy = Policy.load(FILES[0], numbers="int16", calibration=np.load(FILES[2])["observations"])
    data = tmp_path / "host.feather"
    changes = {"objects.robots.brain": "host", "data_filename": str(data)}
    with pogosim.Simulation(None, tmp_path / "scene.yaml", seed=3, set=changes) as sim:
        brain = sim.brain("robots")
        sim.step()
        while not sim.is_over:
            brain.motors[:, :2] = policy.step(observe(brain.photosensors))
            sim.step()
        hosted = sim.to_dataframe()
    hosted = hosted[hosted["robot_category"] == "robots"].sort_values(["time", "robot_id"])
    for column in ("x", "y", "angle"):
        pd.testing.assert_series_equal(rows[column], hosted[column], check_index=False, check_exact=True)


def test_network_of_the_example_can_be_learnt_anew(tmp_path: Path) -> None:
    script = EXAMPLE / "learn.py"
    result = ran(
        tmp_path, sys.executable, script, "--generations", "1", "--folder", tmp_path, env=ENVIRONMENT, timeout=600
    )
    assert (result.code, result.errors) == (0, "")
    assert re.fullmatch(r"light on runs that it was not learnt in: 0\.\d{3}", result.output.splitlines()[-1])
    policy = Policy.load(
        tmp_path / "phototaxis.npz", numbers="int16", calibration=np.load(tmp_path / "observations.npz")["observations"]
    )
    assert policy.network.describe() == "3 inputs, 6 tanh, 2 hardtanh"
