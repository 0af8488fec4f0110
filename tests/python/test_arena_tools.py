"""`pogosim arena` and its older names, as users call them; arenas that are made load in the simulator."""

from __future__ import annotations

import math
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from in_process import called, pogosim, refusal
from pogosim import arenas
from pogosim.geometry.arena_file import Outline, as_csv, parse_outline, read_arena, scaled
from pogosim.geometry.svg_file import read_svg
from pogosim.geometry.validity import problems, room_for
from pogosim.utils import load_dataframe
from project import CLEAN
from running import ROOT, Run, build_folder, example, ran, run

SQUARE = "0,0\n100,0\n100,100\n0,100\n"
SVG = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"{attributes}>{content}</svg>'


def module(folder: Path, *arguments: str) -> Run:
    """Run `python -m` in a folder."""
    return ran(folder, sys.executable, "-m", *arguments, env=CLEAN | {"POGOSIM_DIR": str(build_folder())})


def arena(folder: Path, *arguments: str) -> Run:
    """Call `pogosim arena` in a folder."""
    return pogosim(folder, "arena", *arguments)


def svg(folder: Path, content: str, attributes: str = "") -> Path:
    """Write a drawing."""
    path = folder / "drawing.svg"
    path.write_text(SVG.format(content=content, attributes=attributes))
    return path


def outline(text: str) -> Outline:
    return parse_outline(text, "test.csv")


def says_simulator(folder: Path, file: Path, surface: object) -> Run:
    """Run the simulator on an arena with one small object and debug messages."""
    settings = {"arena_file": str(file), "arena_surface": surface, "simulation_time": 0.1, "objects.robots.nb": 1}
    return run(example("helloworld"), folder, {**settings, "objects.robots.radius": 1.0})


SHIPPED = sorted((ROOT / "arenas").glob("*.csv"))


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_arenas_are_valid_and_let_robots_pass(path: Path) -> None:
    found = read_arena(path)
    assert problems(found) == []
    room = room_for(scaled(found, 1.0e6), 26.5)
    assert len(room.parts) == 1
    assert room.share > 0.95


@pytest.mark.parametrize(
    ("text", "corners"),
    [
        (SQUARE, [4]),
        (SQUARE + "0,0\n", [4]),
        (
            '\ufeff# c\r\n0,0\r\n"100" , 0\r\n100,0\r\n100,1e2\r\n0,+100.\r\n\r\n \t\r\n40,40\r\n60,40\r\n5,6e1',
            [4, 3],
        ),
        ("0,0\r100,0\r100,100\r", [3]),
        ("1000000,0\n1000000.01,0\n1000100,0\n1000100,100\n", [3]),  # the same number in single precision
    ],
)
def test_arena_files_are_read_as_the_simulator_reads_them(text: str, corners: list[int], tmp_path: Path) -> None:
    found = outline(text)
    assert [len(polygon) for polygon in found.polygons] == corners
    (tmp_path / "arena.csv").write_bytes(text.encode())
    result = says_simulator(tmp_path / "run", tmp_path / "arena.csv", 1e6)
    assert (result.code, result.errors) == (0, "")
    polygons = load_dataframe(tmp_path / "run" / "data.feather")[1]["arena_polygons"]
    assert [len(polygon) for polygon in polygons] == corners


INVALID = {
    "bow tie": "0,0\n100,100\n100,0\n0,100\n",
    "touches itself": "0,0\n50,0\n50,50\n100,50\n100,100\n50,50\n0,50\n",
    "line": "0,0\n100,0\n50,0\n",
    "sliver": "0,0\n1000,0\n1000,0.00001\n",
    "hole outside": SQUARE + "\n200,200\n210,200\n200,210\n",
    "hole crosses": SQUARE + "\n90,40\n110,40\n100,60\n",
    "hole touches": SQUARE + "\n50,50\n100,40\n100,60\n",
    "holes cross": SQUARE + "\n10,10\n50,10\n10,50\n\n20,20\n60,20\n20,60\n",
    "hole in a hole": SQUARE + "\n10,10\n50,10\n50,50\n10,50\n\n20,20\n30,20\n20,30\n",
    "hole first": "10,10\n20,10\n10,20\n\n" + SQUARE,
}


@pytest.mark.parametrize("text", INVALID.values(), ids=INVALID.keys())
def test_simulator_refuses_what_is_called_invalid_and_both_say_so(text: str, tmp_path: Path) -> None:
    assert problems(outline(text))
    (tmp_path / "arena.csv").write_text(text)
    assert says_simulator(tmp_path / "run", tmp_path / "arena.csv", 1e6).code == 2
    result = arena(tmp_path, "show", "arena.csv", "out.png")
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert line.startswith("pogosim arena show: arena.csv: ")
    refusal(arena(tmp_path, "scale", "arena.csv", "out.csv", "--area", "1e6"))
    assert not (tmp_path / "out.csv").exists()


def test_scaling_gives_the_area_and_keeps_proportions() -> None:
    found = outline("10,10\n30,10\n30,20\n10,20\n\n12,12\n17,12\n17,16\n12,16\n")
    assert found.area == 180.0
    plain, stretched = scaled(found, 720.0), scaled(found, 720.0, stretch=True)
    assert plain.area == pytest.approx(720.0)
    assert plain.polygons[0].tolist() == pytest.approx(np.array([[0, 0], [40, 0], [40, 20], [0, 20]]))
    assert stretched.area == pytest.approx(720.0)
    assert np.ptp(stretched.polygons[0], axis=0) == pytest.approx([math.sqrt(800.0)] * 2)
    assert scaled(found, None).polygons[1][0].tolist() == [2.0, 2.0]


def test_dumbbell_with_a_neck_narrower_than_a_robot_has_two_parts() -> None:
    def dumbbell(neck: float) -> Outline:
        low, high = 100.0 - neck / 2, 100.0 + neck / 2
        corners = [(0, 0), (200, 0), (200, low), (300, low), (300, 0), (500, 0), (500, 200), (300, 200), (300, high)]
        corners += [(200, high), (200, 200), (0, 200)]
        return outline("".join(f"{x},{y}\n" for x, y in corners))

    assert [len(room_for(dumbbell(neck), 26.5).parts) for neck in (60.0, 54.0, 52.0)] == [1, 1, 2]
    assert room_for(dumbbell(52.0), 200.0).parts == ()


def test_robots_cannot_cover_the_corners_of_a_square() -> None:
    room = room_for(outline(SQUARE), 10.0)
    assert room.share == pytest.approx(1.0 - (4.0 - math.pi) * 100.0 / 1e4, abs=1e-4)


@pytest.mark.parametrize("name", ["annulus", "arena9", "star", "torus"])
@pytest.mark.parametrize("area", [2500.0, 4.0e6])
def test_scaled_arena_has_its_area_in_the_simulator(name: str, area: float, tmp_path: Path) -> None:
    result = arena(tmp_path, "scale", str(ROOT / "arenas" / f"{name}.csv"), "out.csv", "--area", str(area))
    assert (result.code, result.errors) == (0, "")
    found = read_arena(tmp_path / "out.csv")
    assert found.area == pytest.approx(area, rel=1e-4)
    assert found.periodic == (name == "torus")
    result = says_simulator(tmp_path / "run", tmp_path / "out.csv", area)
    assert (result.code, result.errors) == (0, "")
    assert "scaled" not in result.output, "the area is what was asked for already"


@pytest.mark.parametrize("suffix", ["pdf", "png", "svg"])
def test_arena_is_drawn_with_its_size_and_room(suffix: str, tmp_path: Path) -> None:
    (tmp_path / "arena.csv").write_text(SQUARE + "\n40,40\n60,40\n60,60\n40,60\n")
    result = arena(tmp_path, "show", "arena.csv", f"out.{suffix}", "--area", "file", "--radius", "5")
    assert (result.code, result.errors) == (0, "")
    assert "100.0 x 100.0 mm, area 9600.0 mm2, 8 corners, 1 hole" in result.output
    assert "valid: yes" in result.output
    content = (tmp_path / f"out.{suffix}").read_bytes()
    assert {"pdf": b"%PDF", "png": b"\x89PNG", "svg": b"<?xml"}[suffix] == content[
        : len(content[:4])
    ] or suffix == "svg"
    arena(tmp_path, "show", "arena.csv", f"again.{suffix}", "--area", "file", "--radius", "5")
    if suffix != "svg":  # names in it are random
        assert (tmp_path / f"again.{suffix}").read_bytes() == content


def test_arena_where_robots_do_not_fit_is_a_warning(tmp_path: Path) -> None:
    (tmp_path / "arena.csv").write_text(SQUARE)
    result = arena(tmp_path, "show", "arena.csv", "--area", "2000")
    assert result.code == 0
    (line,) = result.errors.splitlines()
    assert line == "pogosim arena show: warning: arena.csv: a robot of radius 26.5 mm does not fit; enlarge the arena"


# Drawings.

SHAPES = {
    "absolute": ('<path d="M 0 0 H 20 V 10 L 0 10 Z"/>', 200.0),
    "relative": ('<path d="m 5 5 h 20 v 10 l -20 0 z"/>', 200.0),
    "hole": ('<path d="m 0 0 h 20 v 10 h -20 z m 5 5 h 2 v 2 h -2 z"/>', 196.0),
    "arcs": ('<path d="M -10 0 A 10 10 0 0 1 10 0 A 10 10 0 0 1 -10 0 Z"/>', 100.0 * math.pi),
    "quadratic": ('<path d="M 0 0 Q 10 20 20 0 Z"/>', 2.0 / 3.0 * 20.0 * 10.0),
    "smooth quadratic": ('<path d="M 0 0 Q 10 20 20 0 T 40 0 L 40 -30 L 0 -30 Z"/>', 1200.0),
    "cubic": ('<path d="M 0 0 C 0 10 30 10 30 0 Z"/>', 0.6 * 30.0 * 10.0),
    "smooth cubic": ('<path d="M 0 0 c 0 10 30 10 30 0 s 30 -10 30 0 L 60 -30 L 0 -30 Z"/>', 1800.0),
    "rectangle": ('<rect x="3" y="4" width="20" height="10"/>', 200.0),
    "rounded rectangle": ('<rect width="20" height="10" rx="2"/>', 200.0 - (4.0 - math.pi) * 4.0),
    "circle": ('<circle cx="5" cy="5" r="10"/>', 100.0 * math.pi),
    "ellipse": ('<ellipse rx="10" ry="5"/>', 50.0 * math.pi),
    "polygon": ('<polygon points="0,0 20,0 20,10"/>', 100.0),
    "transform": ('<g transform="scale(2 3)"><rect width="2" height="5" transform="rotate(20)"/></g>', 60.0),
    "use": ('<defs><rect id="r" width="2" height="5"/></defs><use xlink:href="#r" x="3" transform="scale(2)"/>', 40.0),
    "hidden": ('<rect width="2" height="5"/><rect width="9" height="9" style="display:none"/>', 10.0),
    "clip path": ('<clipPath id="c"><rect width="99" height="99"/></clipPath><rect width="2" height="5"/>', 10.0),
    "hole of its own": ('<circle cx="5" cy="5" r="1"/><rect width="10" height="10"/>', 100.0 - math.pi),
}


@pytest.mark.parametrize(("content", "area"), SHAPES.values(), ids=SHAPES.keys())
def test_shapes_of_drawings_keep_their_area(content: str, area: float, tmp_path: Path) -> None:
    found, warnings = read_svg(svg(tmp_path, content))
    assert warnings == []
    assert problems(found) == []
    assert found.area == pytest.approx(area, rel=1e-3)


def test_arc_goes_the_way_that_its_flags_say(tmp_path: Path) -> None:
    areas = {}
    for flags in ("0 0", "0 1", "1 0", "1 1"):
        found, _ = read_svg(svg(tmp_path, f'<path d="M 0 0 A 10 10 0 {flags} 10 10 Z"/>'))
        areas[flags] = found.area
    small = 100.0 * (math.pi / 4 - 0.5)
    assert areas == pytest.approx(
        {"0 0": small, "0 1": small, "1 0": 100 * math.pi - small, "1 1": 100 * math.pi - small}, rel=2e-3
    )


def test_walls_are_as_near_to_curves_as_asked_for(tmp_path: Path) -> None:
    path = svg(tmp_path, '<circle r="100"/>')
    corners = {}
    for tolerance in (1e-2, 1e-4):
        found, _ = read_svg(path, tolerance=tolerance)
        polygon = found.polygons[0]
        middles = 0.5 * (polygon + np.roll(polygon, -1, axis=0))
        assert np.abs(100.0 - np.hypot(*middles.T)).max() <= tolerance * 200.0 * math.sqrt(2.0)
        corners[tolerance] = len(polygon)
    assert corners[1e-2] < 30 < corners[1e-4] < 400


@pytest.mark.parametrize(
    ("attributes", "size"),
    [
        ("", 10.0),
        (' width="200mm" height="200mm" viewBox="0 0 100 100"', 20.0),
        (' width="20cm" height="20cm" viewBox="0 0 200 200"', 10.0),
        (' width="1in" height="1in" viewBox="0 0 10 10"', 25.4),
        (' width="100" height="100" viewBox="0 0 100 100"', 10.0),
    ],
)
def test_drawing_has_its_size_in_millimetres(attributes: str, size: float, tmp_path: Path) -> None:
    found, _ = read_svg(svg(tmp_path, '<rect width="10" height="10"/>', attributes))
    assert np.ptp(found.polygons[0], axis=0) == pytest.approx([size, size], rel=1e-5)


def test_open_shapes_are_closed_and_lines_left_out_with_a_warning(tmp_path: Path) -> None:
    svg(tmp_path, '<path id="u" d="M 0 0 L 10 0 L 10 10 L 0 10"/><line x1="2" y1="2" x2="8" y2="8"/>')
    result = arena(tmp_path, "from-svg", "drawing.svg", "out.csv")
    assert result.code == 0
    assert result.errors.splitlines() == [
        "pogosim arena from-svg: warning: drawing.svg: 'u' is open; a straight wall closes it",
        "pogosim arena from-svg: warning: drawing.svg: shape 2 (<simpleline>) encloses no area, and is left out",
    ]
    assert read_arena(tmp_path / "out.csv").area == 100.0


def test_parts_of_drawings_can_be_chosen(tmp_path: Path) -> None:
    svg(
        tmp_path,
        '<rect id="page" width="99" height="99"/><g id="arena" transform="scale(2)"><rect width="5" height="5"/></g>'
        '<path d="M 0 0 H 3 V 3 Z"/>',
    )
    refusal(arena(tmp_path, "from-svg", "drawing.svg", "out.csv"))
    for options, area in ((["--element", "arena"], 100.0), (["--first-path"], 4.5), (["--element", "page"], 9801.0)):
        assert arena(tmp_path, "from-svg", "drawing.svg", "out.csv", *options).code == 0
        assert read_arena(tmp_path / "out.csv").area == pytest.approx(area)
    said = refusal(arena(tmp_path, "from-svg", "drawing.svg", "out.csv", "--element", "nothing"))
    assert said.endswith("has no element with the id 'nothing'; there are page, arena")


def test_drawing_becomes_an_arena_of_the_simulator(tmp_path: Path) -> None:
    svg(
        tmp_path,
        '<g transform="rotate(30)"><path d="m 0 0 c 20 -10 40 -10 60 0 v 60 h -60 z m 20 20 a 5 5 0 1 0 9 9 z"/></g>',
    )
    result = arena(tmp_path, "from-svg", "drawing.svg", "out.csv", "--area", "250000")
    assert (result.code, result.errors) == (0, "")
    assert read_arena(tmp_path / "out.csv").area == pytest.approx(250000.0, rel=1e-5)
    assert says_simulator(tmp_path / "run", tmp_path / "out.csv", "file").code == 0


def test_arena_comes_back_from_a_drawing(tmp_path: Path) -> None:
    assert arena(tmp_path, "scale", str(ROOT / "arenas" / "annulus.csv"), "a.csv", "--area", "1e6").code == 0
    assert arena(tmp_path, "to-svg", "a.csv", "a.svg").code == 0
    assert arena(tmp_path, "from-svg", "a.svg", "b.csv").code == 0
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()


def test_small_unit_squares_keep_their_shape_as_text() -> None:
    tiny = outline("0,0\n0.001,0\n0.001,0.001\n0,0.001\n")
    assert outline(as_csv(tiny)).area == pytest.approx(1e-6)


BAD = {
    "missing": (["scale", "none.csv", "out.csv", "--area", "1"], "none.csv: no such file"),
    "folder": (["show", "."], ". is not a file"),
    "empty": (["show", "empty"], "empty: the file has no polygon"),
    "header": (["show", "header.csv"], "header.csv:1: expected a corner 'x,y', found 'x,y'"),
    "nan": (["show", "nan.csv"], "nan.csv:2: expected a corner"),
    "two corners": (["show", "two.csv"], "two.csv:1: this polygon has 2 different corners, and needs at least 3"),
    "binary": (["show", "binary.csv"], "binary.csv is not a text file"),
    "not svg": (["from-svg", "square.csv", "out.csv"], "square.csv is not an SVG file"),
    "html": (["from-svg", "page.svg", "out.csv"], "its root is <html>, expected <svg>"),
    "entities": (["from-svg", "bomb.svg", "out.csv"], "declares XML entities"),
    "no shape": (["from-svg", "text.svg", "out.csv"], "has no shape"),
    "itself": (["scale", "square.csv", "./square.csv", "--area", "5"], "would take the place of square.csv"),
    "suffix": (["scale", "square.csv", "out.txt", "--area", "5"], "out.txt does not end in .csv or .svg"),
    "no folder": (["scale", "square.csv", "no/out.csv", "--area", "5"], "there is no folder"),
    "unwritable": (["scale", "square.csv", "/proc/out.csv", "--area", "5"], "/proc/out.csv: "),
    "area": (["scale", "square.csv", "out.csv", "--area", "-5"], "-5 is not above 0"),
    "action": (["turn"], "invalid choice: 'turn'"),
    "none": ([], "required: ACTION"),
}


@pytest.mark.parametrize(("arguments", "said"), BAD.values(), ids=BAD.keys())
def test_what_cannot_be_done_is_one_line(arguments: list[str], said: str, tmp_path: Path) -> None:
    files = {
        "square.csv": SQUARE,
        "empty": "",
        "header.csv": "x,y\n0,0\n",
        "nan.csv": "0,0\nnan,1\n",
        "two.csv": "0,0\n1,1\n",
    }
    files |= {"page.svg": "<html/>", "text.svg": SVG.format(attributes="", content="<text>A</text>")}
    files["bomb.svg"] = '<!DOCTYPE s [<!ENTITY a "aaa">]><svg>&a;</svg>'
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    (tmp_path / "binary.csv").write_bytes(b"\xff\xfe\x00\x01")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    line = refusal(arena(tmp_path, *arguments))
    assert line.startswith("pogosim arena")
    assert said in line
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


# The names that other scripts call.


def test_older_names_scale_to_15_dm2(tmp_path: Path) -> None:
    (tmp_path / "in.csv").write_text(SQUARE)
    assert module(tmp_path, "pogosim.scale_csv_arena", "in.csv", "out.csv").code == 0
    assert read_arena(tmp_path / "out.csv").area == pytest.approx(150_000.0, rel=1e-5)
    assert module(tmp_path, "pogosim.scale_csv_arena", "in.csv", "out.svg").code == 0
    assert read_svg(tmp_path / "out.svg")[0].area == pytest.approx(150_000.0, rel=1e-5)

    svg(tmp_path, '<rect width="9" height="9"/><path d="m 1 2 h 20 v 10 h -20 z"/><path d="M 0 0 H 9 V 9 Z"/>')
    result = module(tmp_path, "pogosim.convert_and_scale_svg", "drawing.svg", "c.csv", "c.svg")
    assert (result.code, result.errors) == (0, "")
    assert read_arena(tmp_path / "c.csv").polygons[0].tolist() == [[1, 2], [21, 2], [21, 12], [1, 12]]
    assert read_svg(tmp_path / "c.svg")[0].area == pytest.approx(150_000.0, rel=1e-5)


def test_arena_of_a_configuration_is_drawn(tmp_path: Path) -> None:
    (tmp_path / "conf").mkdir()
    (tmp_path / "conf" / "simple.yaml").write_text(
        "arena_file: {default_option: own.csv, batch_options: [own.csv]}\narena_surface: 4.0e4\n"
    )
    (tmp_path / "conf" / "own.csv").write_text(SQUARE)
    result = module(tmp_path, "pogosim.arenas")
    assert (result.code, result.errors) == (0, "")
    assert "200.0 x 200.0 mm, area 40000.0 mm2" in result.output
    assert (tmp_path / "results" / "arena_polygon.pdf").read_bytes()[:4] == b"%PDF"
    options = ["--arena-file", "arenas/disk.csv", "--arena-surface", "31415.9", "--no-save", "--output-dir", "none"]
    result = module(tmp_path, "pogosim.arenas", *options)
    assert result.code == 0
    assert re.search(r"disk.csv: 200\.\d x 200\.\d mm, area 31415.9 mm2", result.output)
    assert not (tmp_path / "none").exists()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--config", "none.yaml"], "none.yaml: no such file"),
        (["--config", "list.yaml"], "list.yaml is not a configuration"),
        (["--config", "broken.yaml"], "broken.yaml is not a configuration"),
        (["--config", "bare.yaml"], "bare.yaml has no arena_file; give one with --arena-file"),
        (["--config", "bare.yaml", "--arena-file", "none.csv"], "there is no arena file none.csv"),
        (["--config", "area.yaml"], "arena_surface is wide; expected a number above 0"),
        (["--arena-surface", "0"], "0 is not above 0"),
    ],
)
def test_missing_inputs_are_one_line(arguments: list[str], said: str, tmp_path: Path) -> None:
    (tmp_path / "list.yaml").write_text("- 1\n")
    (tmp_path / "broken.yaml").write_text("a: [1\n")
    (tmp_path / "bare.yaml").write_text("seed: 1\n")
    (tmp_path / "area.yaml").write_text("arena_file: arenas/disk.csv\narena_surface: wide\n")
    assert said in refusal(called(tmp_path, arenas.main, *arguments))
