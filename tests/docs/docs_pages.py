"""The pages of the documentation in parts: links, headings, code spans, code blocks."""

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]

_FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.S | re.M)
_SPAN = re.compile(r"`([^`\n]+)`")
_LINK = re.compile(r"\]\(([^)\s]+)\)")
_HEADING = re.compile(r"^#+ (.*)$", re.M)
_SAVED_FILE = re.compile(r"this as `([^`]+)`:")


@dataclass(frozen=True, slots=True)
class Block:
    """A fenced code block."""

    page: str
    line: int
    language: str
    text: str


def blocks(page: Path) -> list[Block]:
    """Returns the fenced code blocks of a page; `line` is that of the first line of code."""
    text = page.read_text()
    return [
        Block(page.name, text.count("\n", 0, found.start()) + 2, found[1], found[2]) for found in _FENCE.finditer(text)
    ]


def prose(page: Path) -> str:
    """Returns the page without its code blocks."""
    return _FENCE.sub("", page.read_text())


def spans(page: Path) -> list[str]:
    """Returns the inline code of a page."""
    return [span.replace("\\|", "|") for span in _SPAN.findall(prose(page))]


def links(page: Path) -> list[str]:
    """Returns the targets of the links to files and headings of this repository."""
    return [target for target in _LINK.findall(_SPAN.sub("", prose(page))) if "://" not in target]


def anchors(page: Path) -> set[str]:
    """Returns the anchors of a page's headings, as GitHub and mkdocs make them."""
    titles = (title.replace("`", "").lower() for title in _HEADING.findall(prose(page)))
    return {re.sub(r"[^\w\- ]", "", title).strip().replace(" ", "-") for title in titles}


def tutorial_files() -> set[str]:
    """Returns the paths of the files that a tutorial tells its readers to write."""
    return {name for page in PAGES for name in _SAVED_FILE.findall(page.read_text())}
