"""Pages for the browser, made of a template with marks such as @@TITLE@@."""

from __future__ import annotations

import base64
import re
from collections.abc import Mapping


def filled(template: str, parts: Mapping[str, str]) -> str:
    """Put texts in the places of marks, in one go: names in the texts may look like marks.

    Characters that UTF-8 does not have, such as half of a surrogate pair, become question marks.
    """
    page = re.sub("|".join(map(re.escape, parts)), lambda mark: parts[mark.group()], template)
    return page.encode("utf-8", "replace").decode("utf-8")


def data_uri(content: bytes, kind: str) -> str:
    """Return an address that holds the content itself; kind: "image/png"."""
    return f"data:{kind};base64,{base64.b64encode(content).decode('ascii')}"
