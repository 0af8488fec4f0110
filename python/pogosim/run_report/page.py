"""The page of a report, from its parts. All texts are escaped here; pictures are a part of the page."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from pogosim.lines import printable
from pogosim.pages import data_uri, filled
from pogosim.run_report.figures import Shown
from pogosim.view import assets

FOLDER = Path(__file__).parent


@dataclass
class Report:
    """What a page says."""

    title: str
    lead: str  # a line below the title
    warnings: list[str]
    facts: list[tuple[str, str]]
    command: str  # that repeats the run; empty: there is none
    command_note: str
    state: bytes  # picture of the end, PNG
    state_told: str
    replay: str  # a page of its own; empty: none
    replay_note: str
    figures: list[Shown]
    figures_note: str
    numbers_head: list[str]
    numbers: list[list[str]]
    numbers_note: str
    configuration: str  # that goes with the command; empty: there is none
    configuration_name: str
    others: list[tuple[str, str]] = field(default_factory=list)  # other texts to be unfolded: what they are, and they
    footer: str = ""


def text(value: str) -> str:
    """Return a line of text as HTML; control characters in it are shown."""
    return html.escape(printable(value))


def block(value: str) -> str:
    """Return several lines as HTML."""
    return html.escape("\n".join(map(printable, value.splitlines())))


def page_of(report: Report) -> str:
    """Return the page."""
    parts = {
        "@@TITLE@@": text(report.title),
        "@@LEAD@@": text(report.lead),
        "@@WARNINGS@@": warnings_part(report.warnings),
        "@@FACTS@@": facts_part(report.facts),
        "@@COMMAND@@": command_part(report),
        "@@REPLAY@@": replay_part(report),
        "@@FIGURES@@": figures_part(report),
        "@@NUMBERS@@": numbers_part(report),
        "@@CONFIGURATION@@": configuration_part(report),
        "@@FOOTER@@": text(report.footer),
    }
    style, body = ((FOLDER / name).read_text(encoding="utf-8") for name in ("report.css", "report.html"))
    return assets.page(printable(report.title), style, filled(body, parts))


def note(value: str) -> str:
    """Return a remark; nothing for an empty one."""
    return f'<p class="soft">{text(value)}</p>' if value else ""


def warnings_part(warnings: Sequence[str]) -> str:
    """Return the warnings as a list."""
    if not warnings:
        return ""
    items = "".join(f"<li>{text(warning)}</li>" for warning in warnings)
    return f'<section class="warnings" aria-label="Warnings"><h2>Warnings</h2><ul>{items}</ul></section>'


def facts_part(facts: Sequence[tuple[str, str]]) -> str:
    """Return names and values."""
    return "<dl>" + "".join(f"<dt>{text(name)}</dt><dd>{text(value)}</dd>" for name, value in facts) + "</dl>"


def command_part(report: Report) -> str:
    """Return the command that repeats the run, and the configuration that it needs."""
    if not report.command:
        return note(report.command_note)
    content = data_uri(report.configuration.encode("utf-8", "replace"), "text/yaml")
    name = text(report.configuration_name)
    return (
        f'<p>To repeat it, with <a download="{name}" href="{content}">{name}</a>, the configuration with its seed:</p>'
        f"<pre>{text(report.command)}</pre>{note(report.command_note)}"
    )


def replay_part(report: Report) -> str:
    """Return the replay as a page in the page; printed is the picture of the end."""
    picture = (
        f'<figure class="state{" on-paper" if report.replay else ""}"><img alt="{text(report.state_told)}" '
        f'src="{data_uri(report.state, "image/png")}"><figcaption>{text(report.state_told)}</figcaption></figure>'
    )
    if not report.replay:
        return f"<section><h2>The end</h2>{picture}{note(report.replay_note)}</section>"
    frame = (
        f'<iframe class="on-screen" title="Replay of the run" sandbox="allow-scripts" '
        f'srcdoc="{html.escape(report.replay)}"></iframe>'
    )
    keys = '<p class="soft on-screen">Click into it, then ? lists its keys.</p>'
    return f"<section><h2>Replay</h2>{frame}{picture}{note(report.replay_note)}{keys}</section>"


def figures_part(report: Report) -> str:
    """Return the figures."""
    if not report.figures:
        return ""
    shown = "".join(
        f"<figure><figcaption>{text(own.title)}</figcaption>"
        f'<img alt="{text(own.alt)}" src="{data_uri(own.svg, "image/svg+xml")}"></figure>'
        for own in report.figures
    )
    return f'<section><h2>Over time</h2>{note(report.figures_note)}<div class="figures">{shown}</div></section>'


def numbers_part(report: Report) -> str:
    """Return the table of numbers."""
    if not report.numbers:
        return ""
    head = "".join(f'<th scope="col">{text(name)}</th>' for name in report.numbers_head)
    rows = "".join(
        f'<tr><th scope="row">{text(first)}</th>{"".join(f"<td>{text(value)}</td>" for value in rest)}</tr>'
        for first, *rest in report.numbers
    )
    return (
        f'<section><h2>Numbers</h2><div class="wide"><table><caption>{text(report.numbers_note)}</caption>'
        f"<thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div></section>"
    )


def configuration_part(report: Report) -> str:
    """Return configurations, to be unfolded."""
    texts = [(what, own) for what, own in [("The configuration", report.configuration), *report.others] if own]
    if not texts:
        return ""
    folded = "".join(
        f"<details><summary>{text(what)}</summary><pre>{block(own)}</pre></details>" for what, own in texts
    )
    return f"<section><h2>Configuration</h2>{folded}</section>"
