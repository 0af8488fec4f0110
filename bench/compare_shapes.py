"""Compare how bodies of all shapes move with each physics engine: robots push boxes, wedges and others, over seeds.

    .venv/bin/python bench/compare_shapes.py [--seeds 6] [--time-step 0.01]

Prints a table in Markdown: means over the seeds, with the standard deviation between them. docs/physics.md explains it.
"""

from __future__ import annotations

import argparse
import itertools
import sys
import time

try:
    import numpy as np
    import numpy.typing as npt
    import pogosim
    import shapely
    import yaml
    from pogosim.picture.layers import placed
    from pogosim.shapes import Shape, shape_of
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"compare_shapes.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

from compare_engines import ROOT, with_spread
from options import at_least_one, check_built, seconds

Floats = npt.NDArray[np.float64]

PROGRAM = ROOT / "examples" / "run_and_tumble" / "run_and_tumble.so"
CONFIGURATION = ROOT / "conf" / "shapes.yaml"
BOXES = {
    "type": "passive_object",
    "nb": 6,
    "geometry": "rectangle",
    "body_width": 80,
    "body_height": 50,
    "body_linear_damping": 5.0,
    "body_angular_damping": 5.0,
}
PUSHED = ("boxes", "wedges", "rods", "nuts", "trays")
DURATION_S = 60.0
INTERVAL_S = 0.5
LAG_S = 10.0  # of displacements
COLUMNS = ("robots", *PUSHED, "deepest overlap, mm", "processor s")


def overlap_mm(a: Floats, b: Floats) -> float:
    """Least distance by which one of two convex outlines, of shape (n, 2), has to move to leave the other; 0 apart."""
    if not shapely.Polygon(a).intersects(shapely.Polygon(b)):
        return 0.0
    edges = np.concatenate([np.roll(line, -1, axis=0) - line for line in (a, b)])
    normals = np.column_stack([edges[:, 1], -edges[:, 0]]) / np.linalg.norm(edges, axis=1)[:, None]
    first, second = a @ normals.T, b @ normals.T
    depths = np.minimum(first.max(0) - second.min(0), second.max(0) - first.min(0))
    return max(0.0, float(depths.min()))


def deepest_overlap_mm(poses: Floats, shapes: list[Shape]) -> float:
    """The deepest overlap of two convex bodies at one time. `poses`: x, y and heading, of shape (bodies, 3)."""
    reach = np.array([shape.bounding_radius_mm for shape in shapes])
    near = np.linalg.norm(poses[:, None, :2] - poses[None, :, :2], axis=-1) < reach[:, None] + reach[None]
    convex = [shape.kind != "compound" for shape in shapes]
    outlines = [placed(shape.outline(), pose[None, :2], pose[2:])[0] for shape, pose in zip(shapes, poses, strict=True)]
    return max(
        (
            overlap_mm(outlines[i], outlines[j])
            for i, j in itertools.combinations(range(len(shapes)), 2)
            if near[i, j] and convex[i] and convex[j]
        ),
        default=0.0,
    )


def figures(engine: str, seed: int, time_step_s: float, duration_s: float = DURATION_S) -> list[float]:
    """The figures of one run, in the order of COLUMNS: ways in LAG_S, root mean square, in mm, and the others."""
    objects = yaml.safe_load(CONFIGURATION.read_text())["objects"] | {"boxes": BOXES}
    shapes_of = {name: shape_of(settings) for name, settings in objects.items()}
    settings = {
        "simulation_time": 2 * duration_s,
        "time_step": time_step_s,
        "physics_engine": engine,
        "objects.boxes": BOXES,
        "enable_data_logging": False,
    }
    begin_s = time.process_time()
    poses = []
    with pogosim.Simulation(str(PROGRAM), CONFIGURATION, seed=seed, set=settings) as simulation:
        bodies = [body for body in simulation.objects if body.category in shapes_of]
        categories = np.array([body.category for body in bodies])
        for _ in range(round(duration_s / INTERVAL_S)):
            simulation.step(round(INTERVAL_S / time_step_s))
            poses.append([[*body.position, body.heading] for body in bodies])
    spent_s = time.process_time() - begin_s
    places = np.array(poses)
    lag = round(min(LAG_S, duration_s / 2) / INTERVAL_S)
    squares = ((places[lag:, :, :2] - places[:-lag, :, :2]) ** 2).sum(axis=-1)
    ways = [float(np.sqrt(squares[:, categories == name].mean())) for name in ("robots", *PUSHED)]
    shapes = [shapes_of[name] for name in categories]
    return [*ways, max(deepest_overlap_mm(moment, shapes) for moment in places), spent_s]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=at_least_one, default=6)
    parser.add_argument("--time-step", type=seconds, default=0.01, help="s")
    options = parser.parse_args()
    check_built(parser, PROGRAM)
    print("| engine |" + "|".join(f" {name} " for name in COLUMNS) + "|")
    print("|---" * (len(COLUMNS) + 1) + "|")
    for engine in ("box2d", "disk"):
        runs = [figures(engine, seed, options.time_step) for seed in range(1, options.seeds + 1)]
        cells = map(with_spread, np.mean(runs, 0), np.std(runs, 0))
        print(f"| {engine} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
