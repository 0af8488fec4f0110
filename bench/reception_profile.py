"""How many messages get through: whole simulations against the equation that they should follow.

    .venv/bin/python bench/reception_profile.py

Runs the example `probes` with `conf/probes.yaml` for every setting of the measurements on real robots to which the
article fitted its equation (pogosim.communication.measurements) and many seeds, and compares the share of received
messages with

    P = 1 / (alpha + beta p^gamma c^delta exp(zeta m) + theta p c)

where m is the payload and 3 bytes of header, p the chance to send in a tick and c the neighbours and the sender itself
(Cazenille, Macabre, Bredeche, "Pogosim", eq. 1). The parameters are those of the configuration file.
"""

from __future__ import annotations

import argparse
import csv
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

try:
    import yaml
    from pogosim.communication.measurements import ROBOTS_OWN
    from pogosim.communication.reception_law import SHORT_HEADER_BYTES, DynamicLaw
    from pogosim.utils import load_dataframe
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"reception_profile.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

from options import at_least_one, check_built, seconds

ROOT = Path(__file__).resolve().parents[1]
PROBES = ROOT / "examples" / "probes" / "probes"
CONFIG = ROOT / "conf" / "probes.yaml"
FORMATION = ROOT / "conf" / "probes_formation.csv"
MEASUREMENTS = ROBOTS_OWN

FOCAL_ROBOT = 0
TOLERANCE = 0.03


@dataclass(frozen=True)
class Setting:
    """One column of the measurements: bytes, robots around the sender, chance (%) to send in a tick."""

    payload_size: int
    neighbors: int
    send_percent: int


@dataclass(frozen=True)
class Count:
    """Messages of the focal robot: how many were sent to its neighbours, one for each, and how many were received."""

    sent: int
    received: int

    @property
    def share(self) -> float:
        """Share of received messages, 0 to 1."""
        return self.received / self.sent

    def standard_error(self, probability: float) -> float:
        """Standard deviation of the share if each message is received with this probability."""
        return math.sqrt(probability * (1.0 - probability) / self.sent)


def read_measurements(path: Path = MEASUREMENTS) -> dict[Setting, float]:
    """Share of received messages on real robots, by setting."""
    with path.open(newline="") as file:
        return {
            Setting(int(row["payload_size"]), int(row["nb_neighbors"]), round(100.0 * float(row["p_send"]))): float(
                row["success_probability"]
            )
            for row in csv.DictReader(file)
        }


def read_parameters(path: Path = CONFIG) -> dict[str, float]:
    """Parameters of the equation in a configuration file, `alpha` to `theta`."""
    model = yaml.safe_load(path.read_text())["objects"]["robots"]["msg_success_rate"]
    return {name: float(value) for name, value in model.items() if name != "type"}


def equation(setting: Setting, parameters: Mapping[str, float]) -> float:
    """Reception probability, in [0, 1], that the article's equation gives."""
    m = setting.payload_size + SHORT_HEADER_BYTES
    return float(DynamicLaw(**parameters).probability(m, setting.send_percent / 100.0, setting.neighbors + 1))


def simulate(setting: Setting, seed: int, simulation_time_s: float = 60.0, program: Path = PROBES) -> Count:
    """Run one simulation and count. Raises CalledProcessError if the program fails."""
    poses = FORMATION.read_text().splitlines()[: 1 + setting.neighbors + 1]  # the header, and one line per robot
    settings: dict[str, object] = {
        "objects.robots.nb": setting.neighbors + 1,
        "parameters.payload_size": setting.payload_size,
        "parameters.send_percent": setting.send_percent,
        "simulation_time": simulation_time_s,
        "save_data_period": simulation_time_s,
    }
    with tempfile.TemporaryDirectory() as folder:
        data = Path(folder) / "data.feather"
        formation = Path(folder) / "formation.csv"
        formation.write_text("\n".join(poses) + "\n")
        settings["formation_filename"] = formation
        command = [str(program), "-c", str(CONFIG), "-g", "-q", "-s", str(seed), "--set", f"data_filename={data}"]
        for key, value in settings.items():
            command += ["--set", f"{key}={value}"]
        subprocess.run(command, cwd=ROOT, check=True, timeout=600)
        frame, _ = load_dataframe(data)
    last = frame[frame["time"] == frame["time"].max()]
    focal = last["robot_id"] == FOCAL_ROBOT
    sent = int(last.loc[focal, "sent"].sum())
    return Count(sent=sent * setting.neighbors, received=int(last.loc[~focal, "received"].sum()))


def simulate_all(
    settings: Iterable[Setting], seeds: Sequence[int], simulation_time_s: float = 60.0, progress: bool = False
) -> dict[Setting, Count]:
    """Run every setting with every seed, on all processors, and add up the seeds."""
    runs = [(setting, seed) for setting in settings for seed in seeds]
    totals: dict[Setting, Count] = {}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        counts = pool.map(lambda run: simulate(run[0], run[1], simulation_time_s), runs)
        for done, ((setting, _), count) in enumerate(zip(runs, counts, strict=True), start=1):
            total = totals.get(setting, Count(0, 0))
            totals[setting] = Count(total.sent + count.sent, total.received + count.received)
            if progress:
                print(f"\r{done} of {len(runs)} runs", end="", file=sys.stderr, flush=True)
    if progress:
        print(file=sys.stderr)
    return totals


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table. The exit code is 1 if a setting is further from the equation than the tolerance."""
    parser = argparse.ArgumentParser(description="Reception probability in whole simulations against the equation.")
    parser.add_argument("--seeds", type=at_least_one, default=10, help="simulations per setting (default %(default)s)")
    parser.add_argument("--time", type=seconds, default=60.0, help="simulated time of each, s (default %(default)g)")
    options = parser.parse_args(arguments)
    check_built(parser, PROBES)

    measurements = read_measurements()
    parameters = read_parameters()
    counts = simulate_all(measurements, range(options.seeds), options.time, progress=sys.stderr.isatty())

    print("payload neighbours p_send  measured  equation  simulated  deviation  standard error")
    worst = 0.0
    for setting, count in counts.items():
        expected = equation(setting, parameters)
        deviation = count.share - expected
        worst = max(worst, abs(deviation))
        print(
            f"{setting.payload_size:7d} {setting.neighbors:10d} {setting.send_percent / 100:6.2f}"
            f" {measurements[setting]:9.3f} {expected:9.4f} {count.share:10.4f} {deviation:+10.4f}"
            f" {count.standard_error(expected):15.4f}"
        )
    print(f"largest deviation: {worst:.4f} (tolerance {TOLERANCE}); {options.seeds} seeds of {options.time:g} s each")
    return 0 if worst <= TOLERANCE else 1


if __name__ == "__main__":
    sys.exit(main())
