"""Hooks of mkdocs: add the generated pages, and redirect links to the pages of files outside docs/."""

import re
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files

from tools.docs.api_reference import api_pages
from tools.docs.message_reference import message_reference

_ROOT = Path(__file__).parents[2]
_LCM_LINK = re.compile(r"\]\(\.\./lcmtypes/(\w+)\.lcm\)")


def on_files(files: Files, config: Any) -> Files:
    """Adds README.md as the front page, the message reference and the API reference."""
    front = (_ROOT / "README.md").read_text().replace("](docs/", "](")
    pages = {"index.md": front, "messages.md": message_reference(_ROOT / "lcmtypes"), **api_pages()}
    for name, text in pages.items():
        files.append(File.generated(config, name, content=text))
    return files


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Turns links to .lcm files into links to the message reference."""
    return _LCM_LINK.sub(r"](messages.md#\1)", markdown)
