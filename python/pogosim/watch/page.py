"""The page that shows a live run in a browser."""

from __future__ import annotations

from pathlib import Path

from pogosim.view import assets

FOLDER = Path(__file__).parent
# It talks to its own server, and saves pictures and films.
POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; connect-src 'self'"
)
KEYS = {
    "\u2190 \u2192": "back, and forth again, by a picture; with shift: ten",
    "N": "one time step",
    "R": "reset the run",
    "P, M": "parameters and lamps, messages",
    "S": "save a picture",
    "drag a robot": "move it",
}
LIVE_PROGRAM = ("live_run.js", "live_view.js")


def live_elements() -> str:
    """Return the elements of the view of a live run as HTML."""
    panels, controls = (assets.text_of(name) for name in ("live_panels.html", "live_controls.html"))
    return assets.elements(assets.Parts(KEYS, panels=panels, controls=controls))


def watch_page(title: str) -> str:
    """Return the page; `title`: its name in the browser."""
    script = (FOLDER / "watch.js").read_text(encoding="utf-8")
    program = assets.program(*map(assets.text_of, LIVE_PROGRAM), script)
    body = f"{live_elements()}<script>\n{program}\n</script>"
    return assets.page(title, assets.text_of("view.css"), body, POLICY)
