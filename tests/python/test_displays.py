"""The doctor finds why no window opens, and docs/displays.md explains all that it finds."""

from __future__ import annotations

import os
import re
import shlex
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from display import Display, forwarded, open_display
from pogosim.command.display_check import findings_of
from pogosim.displays.open_window import OF_X, is_loadable
from pogosim.displays.opening import Opening, try_module, try_window
from pogosim.displays.seen import Seen
from pogosim.displays.surroundings import Surroundings
from pogosim.displays.symptoms import AT_DISPLAY, HINTS, WITHOUT_DISPLAY, Symptom, hints_of, reason_of
from pogosim.displays.x_server import Answer, answer_of, numbered
from pogosim.system_packages import PACKAGES
from running import ROOT, build_folder

PAGE = ROOT / "docs" / "displays.md"
WSL_1 = "Linux version 4.4.0-19041-Microsoft (Microsoft@Microsoft.com) (gcc version 5.4.0)"
WSL_2 = "Linux version 5.15.90.1-microsoft-standard-WSL2 (oe-user@oe-host) (x86_64-msft-linux-gcc)"
NOT_FOUND = "cannot open shared object file: No such file or directory"
OF_MACOS = "dlopen(/opt/libpogosim_view-v1.dylib, 0x0006): Library not loaded"
PIP = f"{shlex.quote(sys.executable)} -m pip install pysdl2-dll"
MESA = "libGL error: MESA-LOADER: failed to open swrast: /usr/lib/dri/swrast_dri.so: cannot open shared object file"
LOADED = Opening()
OFFSCREEN = Opening(driver="offscreen")
X11 = Opening(driver="x11")


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """Return a folder that stands for / of a machine that is nothing special."""
    (tmp_path / "proc").mkdir()
    (tmp_path / "etc").mkdir()
    (tmp_path / "etc" / "os-release").write_text("ID=debian\n")
    (tmp_path / "proc" / "version").write_text("Linux version 6.1.0-18-amd64 (debian-kernel@lists.debian.org)")
    return tmp_path


def of_windows(root: Path, kernel: str, *files: str) -> None:
    """Make it a WSL."""
    (root / "proc" / "version").write_text(kernel)
    for file in files:
        (root / file).parent.mkdir(parents=True, exist_ok=True)
        (root / file).touch()


def reason_in(here: Surroundings, opening: Opening = LOADED, x_server: Answer | None = None) -> Symptom:
    """Return why no window opens."""
    found = reason_of(Seen(here, opening, x_server))
    assert found is not None
    return found


def reason(
    root: Path, opening: Opening = LOADED, x_server: Answer | None = None, user: int = 1000, **variables: str
) -> Symptom:
    """Return why no window opens in faked surroundings."""
    return reason_in(Surroundings(variables, root, user, "Linux"), opening, x_server)


def hints(root: Path, opening: Opening, user: int = 1000, **variables: str) -> list[Symptom]:
    """Return what the doctor adds in faked surroundings."""
    return hints_of(Seen(Surroundings(variables, root, user), opening, None), None)


def test_open_window_is_told_with_where_it_is(root: Path) -> None:
    of_windows(root, WSL_2, "mnt/wslg/versions.txt")
    here = Surroundings({"DISPLAY": ":0"}, root)
    (line,) = findings_of(Seen(here, X11, Answer.CONNECTS))
    assert (line.is_fine, line.found) == (True, "opens, by x11 (WSL 2 with WSLg)")


@pytest.mark.parametrize("display", [{}, {"DISPLAY": ":0"}])
@pytest.mark.parametrize(
    ("error", "advice"),
    [
        (f"libSDL2-2.0.so.0: {NOT_FOUND}", "apt install libsdl2-2.0-0"),
        (f"libSDL2-2.0.so: {NOT_FOUND}", PIP),  # of a wheel
        (f"{OF_MACOS}: @rpath/SDL2.framework/Versions/A/SDL2", PIP),
        (f"{OF_MACOS}: /opt/homebrew/opt/sdl2/lib/libSDL2-2.0.0.dylib", "brew install sdl2"),
        (f"libpng16.so.16: {NOT_FOUND}", "install the library that is named here, or Pogosim again"),
    ],
)
def test_missing_library_is_named_with_where_it_comes_from(
    root: Path, error: str, advice: str, display: dict[str, str]
) -> None:
    opening = Opening(load_error=f"{error}\n  Reason: tried: '/usr/lib'")
    system = "Darwin" if OF_MACOS in error else "Linux"
    found = reason_in(Surroundings(display, root, system=system), opening, Answer.CONNECTS)
    assert (found.section, found.found) == ("sdl-is-missing", error)
    assert found.advice_with_link == f"{advice}; see docs/displays.md#sdl-is-missing"


@pytest.mark.parametrize(
    ("release", "advice"),
    [
        ("ID=debian", "apt install libx11-6 libxcursor1"),
        ('NAME="Rocky Linux"\nID="rocky"\nID_LIKE="rhel centos fedora"', "dnf install libX11 libXcursor"),
        ("ID=manjaro\nID_LIKE=arch", "pacman -S libx11 libxcursor"),
        ("ID=nixos", "install what Debian calls libx11-6 libxcursor1"),
    ],
)
def test_missing_library_of_x_is_named_with_the_package_of_the_distribution(
    root: Path, release: str, advice: str
) -> None:
    (root / "etc" / "os-release").write_text(f"{release}\n")
    opening = Opening(error="x11 not available", x_libraries_missing=("libX11.so.6", "libXcursor.so.1"))
    found = reason(root, opening, Answer.CONNECTS, DISPLAY=":0")
    assert (found.section, found.found) == (
        "libraries-of-x-are-missing",
        "no libX11.so.6, no libXcursor.so.1, which SDL needs for X",
    )
    assert found.advice == advice


def test_library_of_x_that_a_window_can_do_without_is_no_reason(root: Path) -> None:
    opening = Opening(driver="offscreen", x_libraries_missing=("libXss.so.1",))
    assert reason(root, opening, Answer.CONNECTS, DISPLAY=":0").section == "the-connection-is-refused"


def test_library_that_is_not_there_is_found_by_loading_it() -> None:
    assert is_loadable("libc.so.6")
    assert not is_loadable("libXno-such-library.so.6")
    assert set(OF_X) <= set(PACKAGES)


def test_macos_needs_no_variable_of_a_display(root: Path) -> None:
    here = Surroundings({}, root, system="Darwin")
    assert here.is_display_named
    found = reason_in(here, Opening(error="No available displays"))
    assert found.found == "no window opens: No available displays"


@pytest.mark.parametrize(
    ("variables", "section", "said"),
    [
        ({}, "no-display", "ssh -X"),
        ({"SSH_CONNECTION": "10.0.0.1 50000 10.0.0.2 22"}, "over-ssh", "ssh -X"),
        ({"SLURM_JOB_ID": "7", "SSH_CONNECTION": "10.0.0.1 50000 10.0.0.2 22"}, "on-a-cluster", "-g"),
        ({"APPTAINER_CONTAINER": "/images/pogosim.sif"}, "in-a-container", "Apptainer"),
    ],
)
def test_no_variable_of_a_display_means_something_else_in_each_place(
    root: Path, variables: dict[str, str], section: str, said: str
) -> None:
    found = reason_in(Surroundings(variables, root, system="Linux"))
    assert found.section == section
    assert found.found.startswith("no display: neither DISPLAY nor WAYLAND_DISPLAY is set")
    assert said in found.found + found.advice


@pytest.mark.parametrize(("file", "kind"), [(".dockerenv", "Docker"), ("run/.containerenv", "Podman")])
def test_containers_are_known_by_their_files(root: Path, file: str, kind: str) -> None:
    (root / file).parent.mkdir(exist_ok=True)
    (root / file).touch()
    assert Surroundings({}, root).container == kind
    assert reason(root).section == "in-a-container"
    shared = reason(root, OFFSCREEN, Answer.NOTHING, DISPLAY=":0")
    assert "-v /tmp/.X11-unix:/tmp/.X11-unix" in shared.advice
    assert reason(root, OFFSCREEN, Answer.NOTHING, DISPLAY="host:0").section == "nothing-answers"


def test_versions_of_wsl(root: Path) -> None:
    assert Surroundings({}, root).wsl == 0
    assert Surroundings({"WSL_DISTRO_NAME": "Debian"}, root).wsl == 2, "a kernel of one's own"
    of_windows(root, WSL_1)
    assert Surroundings({"WSL_DISTRO_NAME": "Debian"}, root).wsl == 1
    of_windows(root, WSL_2)
    here = Surroundings({}, root)
    assert (here.wsl, here.has_wslg, here.described()) == (2, False, "WSL 2 without WSLg")


def test_wsl_without_a_display(root: Path) -> None:
    of_windows(root, WSL_1)
    assert reason(root).section == "wsl-1"
    of_windows(root, WSL_2)
    assert (reason(root).section, "wsl --update" in reason(root).advice) == ("wsl-2-without-wslg", True)
    of_windows(root, WSL_2, "mnt/wslg/versions.txt")
    assert "export DISPLAY=:0" in reason(root).advice


def test_socket_of_wslg_that_is_gone(root: Path) -> None:
    of_windows(root, WSL_2, "mnt/wslg/.X11-unix/X0")
    assert reason(root, OFFSCREEN, Answer.NOTHING, DISPLAY=":0").section == "wslg-has-lost-its-socket"
    (root / "tmp" / ".X11-unix").mkdir(parents=True)
    (root / "tmp" / ".X11-unix" / "X0").touch()
    assert reason(root, OFFSCREEN, Answer.NOTHING, DISPLAY=":0").section == "nothing-answers"


def test_x_server_in_windows_that_does_not_answer(root: Path) -> None:
    of_windows(root, WSL_2)
    without = reason(root, OFFSCREEN, Answer.NOTHING, DISPLAY="172.20.0.1:0")
    assert (without.section, "firewall" in without.advice) == ("an-x-server-in-windows", True)
    of_windows(root, WSL_2, "mnt/wslg/versions.txt")
    left = reason(root, OFFSCREEN, Answer.NOTHING, DISPLAY="172.20.0.1:0")
    assert (left.section, "~/.bashrc" in left.advice) == ("an-x-server-in-windows", True)


@pytest.mark.parametrize("driver", ["dummy", "offscreen"])
def test_driver_that_draws_nowhere(root: Path, driver: str) -> None:
    found = reason(root, Opening(driver=driver), Answer.CONNECTS, DISPLAY=":0", SDL_VIDEODRIVER=driver)
    assert (found.section, found.found) == (
        "nothing-is-shown",
        f"SDL_VIDEODRIVER={driver} draws into memory, not on a screen",
    )


def test_driver_that_is_not_there(root: Path) -> None:
    missing = Opening(error="wayland not available")
    found = reason(root, missing, Answer.CONNECTS, DISPLAY=":0", SDL_VIDEODRIVER="wayland")
    assert (found.section, found.found) == ("another-driver", "SDL_VIDEODRIVER=wayland: wayland not available")


def test_name_of_no_display_and_display_that_is_gone(root: Path) -> None:
    nonsense = reason(root, OFFSCREEN, Answer.NO_NAME, DISPLAY="nonsense")
    assert (nonsense.section, nonsense.found) == ("nothing-answers", "DISPLAY=nonsense is no name of a display")
    gone = reason(root, OFFSCREEN, Answer.NOTHING, DISPLAY="localhost:10.0", SSH_CONNECTION="10.0.0.1 1 10.0.0.2 22")
    assert (gone.section, gone.found) == ("nothing-answers", "nothing answers at DISPLAY=localhost:10.0")
    assert "log in again with ssh -X" in gone.advice
    wayland = reason(root, OFFSCREEN, WAYLAND_DISPLAY="/run/user/1000/wayland-0")
    assert wayland.section == "nothing-answers"
    assert reason(root, Opening(has_answered=False), Answer.CONNECTS, DISPLAY=":0").section == "it-does-not-answer"


def test_refusal_is_told_with_its_reason(root: Path) -> None:
    said = "Authorization required, but no authorization protocol specified"
    found = reason(root, Opening(driver="offscreen", said=f"{said}\n\nerror: XDG"), Answer.CONNECTS, DISPLAY=":0")
    assert (found.section, found.found) == ("the-connection-is-refused", f"DISPLAY=:0 refuses the connection: {said}")
    assert "XAUTHORITY" in found.advice
    far = reason(root, OFFSCREEN, Answer.CONNECTS, DISPLAY="localhost:10.0", SSH_CONNECTION="10.0.0.1 1 10.0.0.2 22")
    assert (far.section, "sudo" in far.advice) == ("the-connection-is-refused", True)


@pytest.mark.parametrize(
    "opening", [Opening(driver="wayland", error="x", said=MESA), Opening(error="EGL not initialized")]
)
def test_wayland_without_opengl(root: Path, opening: Opening) -> None:
    found = reason(root, opening, WAYLAND_DISPLAY="/run/user/1000/wayland-0")
    assert (found.section, found.found) == ("no-opengl", f"no OpenGL: {opening.said or opening.error}")


def test_anything_else_is_told_in_the_words_of_sdl(root: Path) -> None:
    found = reason(root, Opening(error="No available video device"), DISPLAY="/private/tmp/x:0")
    assert (found.section, found.found) == ("something-else", "no window opens: No available video device")


def test_folder_of_wayland_has_to_be_ones_own(root: Path) -> None:
    own = os.getuid()
    folder = root / "runtime"

    def found(user: int = own, name: str = str(folder)) -> str:
        return " ".join(
            hint.found for hint in hints(root, X11, user, WAYLAND_DISPLAY="wayland-0", XDG_RUNTIME_DIR=name)
        )

    assert found(name="") == "XDG_RUNTIME_DIR is not set, and Wayland needs it"
    assert found() == f"XDG_RUNTIME_DIR={folder} is no folder, and Wayland needs it"
    folder.mkdir()
    assert found() == ""
    assert found(own + 1) == f"XDG_RUNTIME_DIR={folder} is the folder of user {own}, not yours, and Wayland needs it"
    assert reason(root, OFFSCREEN, user=own, WAYLAND_DISPLAY="wayland-0").section == "xdg_runtime_dir"
    assert not hints(root, X11, own, XDG_RUNTIME_DIR="/nowhere"), "only Wayland needs it"
    of_windows(root, WSL_2, "mnt/wslg/runtime-dir/wayland-0")
    (hint,) = hints(root, X11, own, WAYLAND_DISPLAY="wayland-0")
    assert "export XDG_RUNTIME_DIR=/mnt/wslg/runtime-dir" in hint.advice


def test_settings_of_opengl_and_slow_lines_are_hints(root: Path) -> None:
    assert not hints(root, X11, DISPLAY=":0", LIBGL_ALWAYS_INDIRECT="0", LIBGL_ALWAYS_SOFTWARE="0")
    found = hints(root, X11, DISPLAY=":0", LIBGL_ALWAYS_INDIRECT="1", LIBGL_ALWAYS_SOFTWARE="1", GALLIUM_DRIVER="d3d12")
    assert [hint.section for hint in found] == ["libgl_always_indirect", "drawn-by-the-processor"]
    assert found[1].found == "LIBGL_ALWAYS_SOFTWARE=1: the processor draws"
    (far,) = hints(root, X11, DISPLAY="localhost:10.0", SSH_CONNECTION="10.0.0.1 1 10.0.0.2 22")
    assert far.section == "slow-over-ssh"


def test_names_of_displays() -> None:
    assert numbered(":0") == numbered("unix:0.0") == ("", 0)
    assert numbered("localhost:10.0") == ("localhost", 10)
    assert numbered("[::1]:2") == ("::1", 2)
    assert numbered("nonsense") is numbered(":") is numbered("") is None
    assert answer_of(Surroundings({"DISPLAY": "127.0.0.1:59999"})) is Answer.NOTHING, "no such port"


# With real displays.


def module() -> Path:
    """Return the module of the window."""
    (file,) = (build_folder() / "src").glob("libpogosim_view-v*")
    return file


def seen_at(display: str, **variables: str) -> Seen:
    """Look at a display as the doctor does."""
    bare = {name: value for name, value in os.environ.items() if name not in ("WAYLAND_DISPLAY", "SDL_VIDEODRIVER")}
    here = Surroundings({**bare, "DISPLAY": display, **variables}, Path("/"))
    return Seen(here, try_window(module(), here.environment), answer_of(here))


@pytest.fixture
def locked(tmp_path: Path) -> Iterator[tuple[Display, Path]]:
    """Open a display that wants a key, and return the file of the key. One key is for all numbers of displays."""
    key = tmp_path / "key"
    cookie = os.urandom(16)
    name = b"MIT-MAGIC-COOKIE-1"
    fields = (b"", b"", name, cookie)
    everywhere = (0xFFFF).to_bytes(2, "big")  # FamilyWild
    key.write_bytes(everywhere + b"".join(len(field).to_bytes(2, "big") + field for field in fields))
    with open_display("-auth", str(key)) as display:
        yield display, key


def test_display_that_wants_a_key(locked: tuple[Display, Path], tmp_path: Path) -> None:
    display, key = locked
    assert findings_of(seen_at(display.name, XAUTHORITY=str(key)))[0].found.startswith("opens, by x11")
    refused = reason_of(seen_at(display.name, XAUTHORITY=str(tmp_path / "none")))
    assert refused is not None
    assert refused.section == "the-connection-is-refused"
    assert "Authorization required" in refused.found
    key_of_another = tmp_path / "another"
    key_of_another.write_bytes(key.read_bytes()[:-16] + bytes(16))
    refused = reason_of(seen_at(display.name, XAUTHORITY=str(key_of_another)))
    assert refused is not None
    assert refused.found == f"DISPLAY={display.name} refuses the connection: Invalid MIT-MAGIC-COOKIE-1 key"


def test_display_through_ssh_opens() -> None:
    with open_display() as display, forwarded(display) as remote:
        seen = seen_at(remote.name, SSH_CONNECTION="10.0.0.1 50000 10.0.0.2 22")
        assert (reason_of(seen), [hint.section for hint in hints_of(seen, None)]) == (None, ["slow-over-ssh"])


def test_display_that_has_ended() -> None:
    with open_display() as display:
        name = display.name
    assert answer_of(Surroundings({"DISPLAY": name})) is Answer.NOTHING
    found = reason_of(seen_at(name))
    assert found is not None
    assert found.section in ("nothing-answers", "in-a-container"), "this test may run in a container"
    assert name in found.found


def test_module_that_cannot_be_loaded(tmp_path: Path) -> None:
    assert try_module(module(), os.environ) == LOADED
    assert "no such file" in try_module(tmp_path / "none.so", os.environ).load_error.lower()
    assert not try_window(module(), {**os.environ, "SDL_VIDEODRIVER": "dummy"}).is_open


def test_display_without_an_answer() -> None:
    with open_display() as display:
        display.server.send_signal(19)  # SIGSTOP
        try:
            opening = try_window(module(), display.environment, longest_s=1.0)
        finally:
            display.server.send_signal(18)
    assert not opening.has_answered


# The page.


def sections() -> dict[str, str]:
    """Return the sections of the page that explain a symptom, by the last part of their addresses."""
    parts = re.split(r"^#{2,3} (.*)$", PAGE.read_text(), flags=re.MULTILINE)
    slugs = (re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in parts[1::2])
    return dict(zip(slugs, parts[2::2], strict=True))


def test_page_explains_all_that_the_doctor_finds() -> None:
    found = {section for section, _ in (*WITHOUT_DISPLAY, *AT_DISPLAY, *HINTS)}
    assert found <= set(sections())
    marked = {name for name, text in sections().items() if "`pogosim doctor`: yes" in text}
    assert marked == found, "the page says of each symptom whether the doctor finds it"
    assert {name for name, text in sections().items() if "`pogosim doctor`: no" in text}


def test_each_symptom_has_a_meaning_a_test_and_a_remedy() -> None:
    for name, text in sections().items():
        if "`pogosim doctor`: " in text:
            assert all(f"**{what}** " in text for what in ("Means:", "Look:", "Do:")), name
