"""Numbers are read with a decimal point, also where the program or Python uses a language that writes a comma."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from running import ROOT, compile_text, run, write_scene

PROGRAM = """
#include <locale.h>
#include <stdio.h>

#include "pogobase.h"

typedef struct { float gain; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

float gain = 0.0F;

static void init(void) {}
static void step(void) {
    pogobot_motor_set(motorL, (uint16_t)(gain * 1000.0F));
}
static void global_setup(void) {
    init_from_configuration(gain);
    printf("gain %d of 10000\\n", (int)(gain * 10000.0F));
    printf("a half is %.1f\\n", 0.5);
}

int main(void) {
    setlocale(LC_ALL, "");
    pogobot_init();
    pogobot_start(init, step);
    SET_CALLBACK(callback_global_setup, global_setup);
    return 0;
}
"""
SCENE = {"simulation_time": 0.5, "objects.robots.nb": 3, "objects.robots.radius": 26.5, "parameters.gain": 0.25}


@pytest.fixture
def comma(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A language with decimal commas, made with the C library's own tool."""
    source = tmp_path / "comma"
    source.write_text('LC_NUMERIC\ndecimal_point "<U002C>"\nthousands_sep ""\ngrouping -1\nEND LC_NUMERIC\n')
    made = tmp_path / "locales" / "comma"
    made.parent.mkdir()
    subprocess.run(["localedef", "-c", "-i", source, made], capture_output=True, check=False, timeout=60)
    assert (made / "LC_NUMERIC").is_file()
    monkeypatch.setenv("LOCPATH", str(made.parent))
    monkeypatch.setenv("LC_ALL", "comma")


@pytest.mark.usefixtures("comma")
def test_program_with_another_locale_gets_the_same_numbers(tmp_path: Path) -> None:
    prog = compile_text(tmp_path, PROGRAM)
    result = run(prog, tmp_path / "run", SCENE)
    assert result.code == 0, result.text
    assert "a half is 0,5" in result.text, "the locale is in use"
    assert "gain 2500 of 10000" in result.text


@pytest.mark.usefixtures("comma")
def test_simulation_in_a_python_with_another_locale_is_the_same(tmp_path: Path) -> None:
    settings = {"arena_file": str(ROOT / "arenas" / "disk.csv"), "objects.robots.radius": 26.9, "time_step": 0.008}
    scene = write_scene(tmp_path, {**settings, "parameters.gain": 0.25})
    program = ROOT / "examples" / "hanabi" / "hanabi.so"
    script = tmp_path / "script.py"
    script.write_text(
        "import locale, sys, pogosim\n"
        "locale.setlocale(locale.LC_ALL, sys.argv[1])\n"
        f"with pogosim.Simulation({str(program)!r}, {str(scene)!r}, seed=1) as sim:\n"
        "    sim.run(0.5)\n"
        "    print(locale.localeconv()['decimal_point'], sim.state_hash, sim.time_step)\n"
    )
    points, hashes, steps = zip(
        *(
            subprocess.run(
                [sys.executable, script, language], capture_output=True, text=True, timeout=120, check=True
            ).stdout.split()
            for language in ("comma", "C")
        ),
        strict=True,
    )
    assert points == (",", ".")
    assert hashes[0] == hashes[1]
    assert steps == ("0.008", "0.008")
