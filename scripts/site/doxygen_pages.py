"""Pages of reference for C and C++ headers, from what doxygen reads: a heading and its text for each declaration.

Doxygen knows the languages, and its XML is all that is used. What it says of our headers is a few kinds of text only,
so the step from XML to Markdown is short, and no plugin for MkDocs is needed.
"""

from __future__ import annotations

import html
import re
import subprocess
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

Element = ElementTree.Element


@dataclass
class Member:
    """A function, variable, type or macro."""

    name: str
    declaration: str
    text: str
    file: str
    line: int


@dataclass
class Header:
    """A header, its declarations, and its structs and classes with theirs."""

    name: str
    text: str = ""
    members: list[Member] = field(default_factory=list)
    types: list[tuple[Member, list[Member]]] = field(default_factory=list)


def read_headers(settings: Sequence[str], root: Path, folder: Path) -> dict[str, Header]:
    """Run doxygen in `root` with these settings, and return its headers by path."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = [*settings, f"OUTPUT_DIRECTORY = {folder}", "GENERATE_HTML = NO", "GENERATE_XML = YES"]
    lines += ["XML_PROGRAMLISTING = NO", "QUIET = YES"]
    try:
        made = subprocess.run(
            ["doxygen", "-"], cwd=root, input="\n".join(lines), capture_output=True, text=True, check=False
        )
    except FileNotFoundError:
        raise RuntimeError("doxygen is not installed; scripts/site.sh installs it") from None
    if made.returncode != 0:
        raise RuntimeError(f"doxygen failed: {made.stderr}")
    headers: dict[str, Header] = {}
    for path in sorted((folder / "xml").glob("*.xml")):
        for compound in ElementTree.parse(path).iter("compounddef"):
            location = compound.find("location")
            kind = compound.get("kind")
            if location is None or kind not in {"file", "struct", "class", "union", "namespace"}:
                continue
            members = [described(member) for member in members_of(compound) if is_shown(member)]
            file = location.get("file", "")
            if kind in {"file", "namespace"}:
                for member in members:
                    headers.setdefault(member.file, Header(member.file)).members.append(member)
                if kind == "file":
                    headers.setdefault(file, Header(file)).text = text_of(compound)
            elif compound.get("prot", "public") == "public":
                name = (compound.findtext("compoundname") or "").removeprefix("pogosim::")
                if "@" not in name:  # those without a name are part of what has one
                    itself = Member(name, f"{kind} {name}", text_of(compound), file, int(location.get("line", "0")))
                    headers.setdefault(file, Header(file)).types.append((itself, members))
    for header in headers.values():
        seen: set[tuple[str, str]] = set()  # a file's members are also its namespace's
        every = sorted(header.members, key=lambda member: member.line)
        header.members = []
        for member in every:
            if (member.name, member.declaration) not in seen:
                seen.add((member.name, member.declaration))
                header.members.append(member)
        header.types.sort(key=lambda entry: entry[0].line)
    return headers


def members_of(compound: Element) -> Iterator[Element]:
    """Yield what a file, namespace or class declares."""
    for section in compound.findall("sectiondef"):
        yield from section.findall("memberdef")


def is_shown(member: Element) -> bool:
    """Tell whether users of a header see a member."""
    return member.get("prot") == "public" and member.get("kind") != "friend"


def described(member: Element) -> Member:
    """Return a declaration as in C, and its text."""
    kind = member.get("kind")
    name = member.findtext("name") or ""
    arguments = member.findtext("argsstring") or ""
    value_type = all_text(member.find("type"))
    initial = all_text(member.find("initializer"))
    if kind == "define":
        parameters = [parameter.findtext("defname") or "" for parameter in member.findall("param")]
        declaration = f"#define {name}" + (f"({', '.join(parameters)})" if parameters else "")
    elif kind == "enum":
        values = [
            f"{value.findtext('name')} {all_text(value.find('initializer'))}".strip()
            for value in member.findall("enumvalue")
        ]
        if name.startswith("@"):  # it has none
            start, name = "enum", values[0].split()[0]
        else:
            start = f"enum {name}"
        declaration = f"{start} {{{', '.join(values)}}}"
        if len(declaration) > 90:
            declaration = "\n".join([f"{start} {{", *(f"    {value}," for value in values), "}"])
            return Member(name, declaration, text_of(member), *place_of(member))
    elif kind == "typedef":
        declaration = member.findtext("definition") or ""
    else:
        declaration = f"{value_type} {name}{arguments}".strip()
        if kind == "variable" and initial and "\n" not in initial and len(initial) < 40:
            declaration += f" {initial}"
    return Member(name, tidy(declaration), text_of(member), *place_of(member))


def place_of(member: Element) -> tuple[str, int]:
    """Return file and line of a declaration."""
    location = member.find("location")
    if location is None:
        return "", 0
    line = location.get("declline", location.get("line", "0"))
    return location.get("declfile", location.get("file", "")), int(line)


def all_text(element: Element | None) -> str:
    """Return the text of an element and all those in it."""
    return "" if element is None else "".join(element.itertext())


def tidy(declaration: str) -> str:
    """Remove doxygen's blanks and our namespace."""
    text = declaration.replace("pogosim::", "").replace("< ", "<").replace(" >", ">")
    return re.sub(r"\s+", " ", text).replace(" *", "* ").replace(" &", "& ").replace("  ", " ")


def text_of(element: Element) -> str:
    """Return the description of a declaration as Markdown."""
    parts = [element.find("briefdescription"), element.find("detaileddescription")]
    texts = [markdown_of(part).strip() for part in parts if part is not None]
    return "\n\n".join(text for text in texts if text)


def markdown_of(element: Element) -> str:
    """Convert a description of doxygen."""
    text = escape(element.text or "")
    for child in element:
        if child.tag == "para":
            text += markdown_of(child).strip() + "\n\n"
        elif child.tag == "computeroutput":
            text += f"`{all_text(child)}`"
        elif child.tag in {"itemizedlist", "orderedlist"}:
            items = [markdown_of(item).strip().replace("\n", "\n    ") for item in child.findall("listitem")]
            text += "\n\n" + "\n".join(f"- {item}" for item in items) + "\n\n"
        elif child.tag in {"verbatim", "programlisting"}:
            text += "\n\n```c\n" + all_text(child).strip("\n") + "\n```\n\n"
        elif child.tag == "simplesect":  # @range
            title, paragraph = child.find("title"), child.find("para")
            text += f"\n\n{all_text(title)} {markdown_of(paragraph).strip() if paragraph is not None else ''}\n\n"
        elif child.tag == "ndash":
            text += "–"  # noqa: RUF001
        else:
            text += markdown_of(child)
        text += escape(child.tail or "")
    return text


def escape(text: str) -> str:
    """Keep characters from being Markdown."""
    return re.sub(r"([\\*_`\[\]])", r"\\\1", html.escape(text, quote=False))


def grouped(members: Iterable[Member]) -> Iterator[list[Member]]:
    """Yield members in groups that share a text, as between ///@{ and ///@}."""
    group: list[Member] = []
    for member in members:
        if group and member.text and member.text == group[-1].text:
            group.append(member)
        else:
            if group:
                yield group
            group = [member]
    if group:
        yield group


def declarations(members: Sequence[Member], level: int, language: str) -> str:
    """Return a section for each group of members."""
    parts = []
    for group in grouped(members):
        names = list(dict.fromkeys(member.name for member in group if member.name))
        parts.append(f"{'#' * level} {', '.join(f'`{name}`' for name in names)}\n")
        parts.append(f"```{language}\n" + "\n".join(member.declaration for member in group) + "\n```\n")
        if group[0].text:
            parts.append(f"{group[0].text}\n")
    return "\n".join(parts)


def structure(itself: Member, members: Sequence[Member], level: int, language: str) -> str:
    """Return the section of a struct or class: its text, and its members as code with their texts as comments."""
    lines = [f"{itself.declaration} {{"]
    for group in grouped(members):
        if group[0].text:
            plain = re.sub(r"\\(.)", r"\1", html.unescape(" ".join(group[0].text.split()))).replace("`", "")
            lines += [f"    // {line}" for line in wrapped(plain, 100)]
        lines += [f"    {member.declaration};" for member in group]
    lines.append("};" if members else "")
    code = "\n".join(lines) if members else f"{itself.declaration};"
    text = f"{itself.text}\n\n" if itself.text else ""
    return f"{'#' * level} `{itself.name}`\n\n{text}```{language}\n{code}\n```\n"


def wrapped(text: str, width: int) -> list[str]:
    """Break a text into lines."""
    lines = [""]
    for word in text.split():
        if len(lines[-1]) + len(word) >= width and lines[-1]:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return lines


def introduction(path: Path) -> str:
    """Return the comment at the top of a header."""
    lines = []
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.startswith("//"):
            break
        lines.append(line.lstrip("/").removeprefix(" "))
    paragraphs = "\n".join(lines).split("\n\n")
    # Drawings and tables are indented, or have arrows.
    return "\n\n".join(
        f"```text\n{text}\n```" if re.search(r"^ |  |──", text, re.MULTILINE) else escape(text) for text in paragraphs
    )
