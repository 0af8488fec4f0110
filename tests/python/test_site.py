"""The site of the documentation: every page, all links, and a search that needs no network."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from chromium import CHROMIUM
from project import CLEAN
from running import ROOT

sys.path.insert(0, str(ROOT / "scripts" / "site"))

from doxygen_pages import read_headers
from links import OUTSIDE, for_site, page_of

ENVIRONMENT = CLEAN | {"NO_MKDOCS_2_WARNING": "1"}


def build(folder: Path, configuration: Path = ROOT / "mkdocs.yml") -> subprocess.CompletedProcess[str]:
    """Build the site as scripts/site.sh does, in a folder."""
    command = [
        sys.executable,
        "-m",
        "mkdocs",
        "build",
        "--strict",
        "-f",
        str(configuration),
        "-d",
        str(folder),
    ]
    return subprocess.run(command, cwd=ROOT, env=ENVIRONMENT, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The built site."""
    folder = tmp_path_factory.mktemp("site")
    made = build(folder)
    assert made.returncode == 0, made.stdout + made.stderr
    return folder


class Page(HTMLParser):
    """What a page links to and fetches, and the names of places in it."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.fetched: list[str] = []
        self.names: set[str] = set()
        self.feed(path.read_text())

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note what a tag refers to."""
        given = {name: value or "" for name, value in attrs}
        self.names |= {given[name] for name in ("id", "name") if name in given}
        if tag == "a" and "href" in given:
            self.links.append(given["href"])
        elif tag in {"script", "img", "iframe"} and "src" in given:
            self.fetched.append(given["src"])
        elif tag == "link" and given.get("rel") in {"stylesheet", "icon"}:
            self.fetched.append(given["href"])


@pytest.fixture(scope="module")
def pages(site: Path) -> dict[Path, Page]:
    return {path: Page(path) for path in site.rglob("*.html") if path.name != "404.html"}


def targets(path: Path, references: list[str]) -> Iterator[tuple[str, Path, str]]:
    """Yield the references within the site, with file and place in it."""
    for reference in references:
        parts = urlsplit(reference)
        if not parts.scheme:
            yield (
                reference,
                (path.parent / unquote(parts.path)).resolve() if parts.path else path,
                unquote(parts.fragment),
            )


def test_links_of_the_site_lead_to_pages_and_places_in_them(pages: dict[Path, Page]) -> None:
    assert len(pages) > 100
    lost = []
    for path, page in pages.items():
        for reference, target, place in targets(path, page.links):
            if not target.is_file() or (place and target in pages and place not in pages[target].names):
                lost.append(f"{path.name}: {reference}")
    assert lost == []


def test_nothing_is_fetched_from_elsewhere(pages: dict[Path, Page], site: Path) -> None:
    for path, page in pages.items():
        assert [reference for reference in page.fetched if urlsplit(reference).scheme not in {"", "data"}] == [], path
        assert [reference for reference, target, _ in targets(path, page.fetched) if not target.is_file()] == [], path
    assert "unpkg.com" not in (site / "404.html").read_text()


def test_every_page_is_on_the_site(pages: dict[Path, Page], site: Path) -> None:
    names = {path.relative_to(site).with_suffix(".md").as_posix() for path in pages}
    documents = [path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").glob("*.md")]
    assert {page_of(path) for path in [*documents, *OUTSIDE]} <= names
    folders = [path for path in (ROOT / "src").iterdir() if path.is_dir() and not path.is_symlink()]
    rooms = [path.name for path in folders if path.name != "emu"]  # a part of firmware, not of the simulator
    assert {f"reference/rooms/{room}.md" for room in rooms} <= names


def test_navigation_has_every_page_but_source_files(site: Path, pages: dict[Path, Page]) -> None:
    start = Page(site / "index.html")
    reached = {target for _, target, _ in targets(site / "index.html", start.links)}
    # Tabs lead to the first page of each part, whose side bar has the others.
    for path in list(reached):
        reached |= {target for _, target, _ in targets(path, pages[path].links)} if path in pages else set()
    assert [path.name for path in pages if path not in reached and "source" not in path.parts] == []


@pytest.mark.parametrize("is_named", [True, False], ids=["named", "missing"])
def test_page_that_is_missing_in_the_navigation_is_an_error(is_named: bool, tmp_path: Path) -> None:
    """With all settings of the site, but for two pages only, and none that hooks and plugins make."""
    head, _, navigation = (ROOT / "mkdocs.yml").read_text().partition("\nnav:\n")
    assert "          - Debugging: debugging.md\n" in navigation
    head = re.sub(r"\nhooks: .*\nplugins:\n(?: .*\n)+", "\nplugins: [search]\n", head)
    pages = ["index.md", *(["debugging.md"] if is_named else [])]
    (tmp_path / "mkdocs.yml").write_text(f"{head}\nnav: [{', '.join(pages)}]\n")
    (tmp_path / "docs").mkdir()
    for name in ("index.md", "debugging.md"):
        (tmp_path / "docs" / name).write_text("# A page\n")
    (tmp_path / "docs" / "assets").mkdir()
    (tmp_path / "docs" / "assets" / "site.css").touch()
    made = build(tmp_path / "site", tmp_path / "mkdocs.yml")
    assert made.returncode == (0 if is_named else 1), made.stdout + made.stderr
    assert ("debugging.md" in made.stdout + made.stderr) == (not is_named)


def test_reference_has_what_programs_call(site: Path) -> None:
    motors = (site / "reference" / "c" / "motors.html").read_text()
    assert 'id="pogobot_motor_power_set-pogobot_motor_set"' in motors
    assert "An unknown motor does nothing." in motors
    assert "Messages lost to full queues since the start." in (site / "reference" / "rooms" / "world.html").read_text()
    assert "queues_" not in (site / "reference" / "rooms" / "world.html").read_text()
    assert 'id="pogosim.utils.load_dataframe"' in (site / "reference" / "python" / "pogosim.html").read_text()


@pytest.mark.skipif(CHROMIUM is None, reason="no chromium")
def test_search_finds_words_in_a_page_that_is_read_from_a_file(site: Path) -> None:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page()
        asked: list[str] = []
        page.on("request", lambda request: asked.append(request.url))
        for start in ("index.html", "reference/c/motors.html"):  # at different depths
            page.goto((site / start).as_uri())
            page.keyboard.press("f")
            page.keyboard.type("photosensor")
            page.locator(".md-search-result__link").first.wait_for()
            assert "matching document" in page.locator(".md-search-result__meta").inner_text()
            assert page.locator(".md-search-result__link[href*='sensors.html']").count() > 0
        browser.close()
    assert [url for url in asked if urlsplit(url).scheme not in {"file", "data", "blob"}] == []


def test_links_are_those_of_the_site_and_code_stays_as_it_is() -> None:
    noted: list[str] = []
    text = "[a](../src/world/world.hpp) [b](window.md#speed) [c](https://x.org/a.md) [d](../README.md)\n"
    code = "```c\ncall(array[i](../src/world/world.hpp));\n```\n"
    expected = "[a](source/src/world/world.hpp.md) [b](window.md#speed) [c](https://x.org/a.md) [d](index.md)\n"
    assert for_site(text + code + text, "docs/debugging.md", noted.append) == expected + code + expected
    assert set(noted) == {"src/world/world.hpp", "docs/window.md", "README.md"}


def test_links_that_lead_nowhere_are_left_for_mkdocs_to_find() -> None:
    assert for_site("[a](nowhere.md)", "docs/debugging.md", lambda _: None) == "[a](nowhere.md)"


def test_descriptions_keep_lists_code_and_characters(tmp_path: Path) -> None:
    header = tmp_path / "a.h"
    header.write_text(
        "/// @file\n/// About a * b.\n\n"
        "/// Adds `x_1` < 3 to y_2:\n/// - one\n/// - two\nint add(int x_1, int* y_2);\n\n"
        "///@{\n/// Both.\nvoid f(void);\nvoid g(void);\n///@}\n"
        "enum { kFirst = 1, kSecond };\n"
    )
    settings = [f"INPUT = {header}", "DISTRIBUTE_GROUP_DOC = YES", "JAVADOC_AUTOBRIEF = YES", "EXTRACT_ALL = YES"]
    settings += [f"STRIP_FROM_PATH = {tmp_path}", "OPTIMIZE_OUTPUT_FOR_C = YES"]
    read = read_headers(settings, tmp_path, tmp_path / "xml")["a.h"]
    assert read.text == r"About a \* b."
    members = {member.name: member for member in read.members}
    assert members["add"].declaration == "int add(int x_1, int* y_2)"
    assert re.fullmatch(r"Adds `x_1` &lt; 3 to y\\_2:\n\n- one\n- two", members["add"].text)
    assert members["f"].text == members["g"].text == "Both."
    assert members["kFirst"].declaration == "enum {kFirst = 1, kSecond}"
