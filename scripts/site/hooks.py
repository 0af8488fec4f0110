"""What MkDocs calls while it builds the site: adds the pages that are not files of docs/, and mends links.

See mkdocs.yml. scripts/site.sh builds the site.
"""

from __future__ import annotations

import posixpath
import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from links import OUTSIDE, ROOT, SOURCES, for_site, page_of, source_page
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from reference import c_pages, python_pages, room_pages

STYLE = "site.css"
WORKER = "file_worker.js"
# The theme would fetch this one from the network when it is read.
FETCHED = re.compile(r'<script src="https://unpkg\.com/iframe-worker/shim"></script>')


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the README and the other pages outside of docs/, the reference, and source files that pages link to."""
    with tempfile.TemporaryDirectory() as folder:
        pages = c_pages(Path(folder) / "c") | room_pages(Path(folder) / "rooms") | python_pages()
    for path, place in OUTSIDE.items():
        pages[place] = (ROOT / path).read_text(encoding="utf-8")

    linked: set[str] = set()
    for path in [*OUTSIDE, *(f"docs/{file.src_uri}" for file in files.documentation_pages())]:
        for_site((ROOT / path).read_text(encoding="utf-8"), path, linked.add)
    waiting = linked.copy()
    while waiting:
        path = waiting.pop()
        place = page_of(path)
        if place.startswith(SOURCES) and place not in pages:
            pages[place] = source_page(path, waiting.add)

    for name in (STYLE, WORKER):
        pages[f"assets/{name}"] = (Path(__file__).parent / name).read_text(encoding="utf-8")
    for place, text in pages.items():
        files.append(File.generated(config, place, content=text))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Mend the links of pages that are files of the repository."""
    del config, files
    path = next((path for path, place in OUTSIDE.items() if place == page.file.src_uri), f"docs/{page.file.src_uri}")
    return for_site(markdown, path, lambda _: None) if (ROOT / path).exists() else markdown


def on_post_page(output: str, page: Page, config: MkDocsConfig) -> str:
    """Take the stand-in for workers from the site itself."""
    del config
    script = posixpath.relpath(f"assets/{WORKER}", posixpath.dirname(page.file.dest_uri) or ".")
    return FETCHED.sub(f'<script src="{script}"></script>', output)


def on_post_template(output_content: str, template_name: str, config: MkDocsConfig) -> str:
    """Leave it out of pages that no file leads to, such as 404.html."""
    del template_name, config
    return FETCHED.sub("", output_content)
