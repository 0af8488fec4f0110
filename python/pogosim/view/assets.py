"""The files that make the view of a run: its elements, its style and its program, put together for a page."""

from __future__ import annotations

import html
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from pogosim.pages import filled

FOLDER = Path(__file__).parent
POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"  # without a network
# What every view needs, each file after those that it uses.
COMMON = (
    "space.js",
    "cache.js",
    "colours.js",
    "tracks.js",
    "light.js",
    "heat_map.js",
    "marks.js",
    "trails.js",
    "links.js",
    "body_links.js",
    "painter.js",
    "switches.js",
    "pointers.js",
    "swarm_view.js",
)


def text_of(name: str) -> str:
    """Return a file of this package."""
    return (FOLDER / name).read_text(encoding="utf-8")


def program(*own: str) -> str:
    """Return the program of a page: what every view needs, and then texts of programs of its own."""
    parts = [*map(text_of, COMMON), *own]
    return '(() => {\n"use strict";\n\n' + "\n".join(parts) + "})();"


@dataclass(frozen=True)
class Parts:
    """What views differ in.

    Attributes:
        keys: What is said in the help of keys that not every view has, by the keys.
        heading: The title before the program has one.
        clock: Likewise, the time.
        picture: Likewise, HTML of a picture.
        without: What is said where programs are blocked.
        panels: HTML over the arena.
        controls: HTML among the controls below it.
    """

    keys: Mapping[str, str]
    heading: str = ""
    clock: str = ""
    picture: str = ""
    without: str = ""
    panels: str = ""
    controls: str = ""


def module(*own: str) -> str:
    """Return the same as a module of JavaScript, which exports what the last text says."""
    return "\n".join([*map(text_of, COMMON), *own])


def elements(own: Parts) -> str:
    """Return the elements of a view as HTML."""
    parts = {
        "@@HEADING@@": html.escape(own.heading),
        "@@CLOCK@@": html.escape(own.clock),
        "@@PICTURE@@": own.picture,
        "@@NOSCRIPT@@": f"<noscript><p>{html.escape(own.without)}</p></noscript>" if own.without else "",
        "@@KEYS@@": "\n".join(
            f"<dt>{html.escape(key)}</dt><dd>{html.escape(does)}</dd>" for key, does in own.keys.items()
        ),
        "@@PANELS@@": own.panels,
        "@@CONTROLS@@": own.controls,
    }
    return filled(text_of("view.html"), parts)


def page(title: str, style: str, body: str, policy: str = POLICY) -> str:
    """Return a whole page.

    Args:
        title: Its name in the browser, plain text.
        style: CSS.
        body: HTML.
        policy: What the browser may load for it (Content-Security-Policy).
    """
    parts = {"@@TITLE@@": html.escape(title), "@@POLICY@@": policy, "@@STYLE@@": style, "@@BODY@@": body}
    return filled(text_of("page.html"), parts)
