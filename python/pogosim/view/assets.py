"""The files that make the view of a run: its elements, its style and its program, put together for a page."""

from __future__ import annotations

import html
from collections.abc import Mapping
from pathlib import Path

from pogosim.pages import filled

FOLDER = Path(__file__).parent
POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"  # without a network
# What every view needs, each file after those that it uses.
COMMON = ("space.js", "tracks.js", "painter.js", "swarm_view.js")


def text_of(name: str) -> str:
    """Return a file of this package."""
    return (FOLDER / name).read_text(encoding="utf-8")


def program(*own: str) -> str:
    """Return the program of a page: what every view needs, and then texts of programs of its own."""
    parts = [*map(text_of, COMMON), *own]
    return '(() => {\n"use strict";\n\n' + "\n".join(parts) + "})();"


def elements(keys: Mapping[str, str], heading: str = "", clock: str = "", picture: str = "", without: str = "") -> str:
    """Return the elements of a view as HTML.

    Args:
        keys: What is said in its help of keys that not every view has, by the keys.
        heading: Before the program has one.
        clock: Likewise, the time.
        picture: Likewise, HTML of a picture.
        without: What is said where programs are blocked.
    """
    parts = {
        "@@HEADING@@": html.escape(heading),
        "@@CLOCK@@": html.escape(clock),
        "@@PICTURE@@": picture,
        "@@NOSCRIPT@@": f"<noscript><p>{html.escape(without)}</p></noscript>" if without else "",
        "@@KEYS@@": "\n".join(f"<dt>{html.escape(key)}</dt><dd>{html.escape(does)}</dd>" for key, does in keys.items()),
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
