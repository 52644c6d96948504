"""The API reference: one page a subject, each with directives that mkdocstrings turns into documentation."""

from importlib import import_module
from typing import get_args

import fwk
import fwk.testing

SUBJECTS = {
    "component": ("Components and settings", ["Component", "Config", "Field", "Alike"]),
    "channels": (
        "Channels",
        [
            "Reads",
            "Writes",
            "Each",
            "channel",
            "Header",
            "MessageError",
            "Blackboard",
            "BlackboardEvent",
            "NotOpenError",
        ],
    ),
    "services": (
        "Commands and requests",
        ["Serves", "Request", "RequestState", "Calls", "Call", "ServiceError"],
    ),
    "images": ("Images", ["Image", "VisionMaster", "FrameError"]),
    "run": ("Time, log and control", ["Clock", "TimeSource", "Logger", "LogLines", "MainLoop", "PluginControl"]),
    "aspects": (
        "Provided aspects",
        ["Aspect", "Transforms", "Transform", "TransformTree", "TransformError", "transform_message"],
    ),
}
"""File name of a page to its title and its names; names of the public API on no page go to `more`."""


def api_pages() -> dict[str, str]:
    """Returns file name to Markdown for every page of the API reference; all of `fwk.__all__` and `fwk.testing`."""
    pages = {}
    remaining = set(fwk.__all__)
    for subject, (title, names) in SUBJECTS.items():
        public = [name for name in names if name in remaining]
        remaining -= set(public)
        if public:
            pages[f"api/{subject}.md"] = _page(title, "fwk", public)
    if remaining:
        pages["api/more.md"] = _page("More names", "fwk", sorted(remaining))
    pages["api/testing.md"] = _page("Testing", "fwk.testing", sorted(fwk.testing.__all__))
    return pages


def _page(title: str, package: str, names: list[str]) -> str:
    text = f"# {title}\n\nImported with `from {package} import {', '.join(names)}`.\n"
    for name in names:
        text += f"\n## {name}\n\n{_body(package, name)}\n"
    return text


def _body(package: str, name: str) -> str:
    """Returns a directive for mkdocstrings; for a name of another library a sentence."""
    found = getattr(import_module(package), name)
    source = str(found.__module__).partition(".")[0]
    if source != "fwk" and not get_args(found):  # an alias of types has the module of its origin
        return f"`{name}` of the library `{source}`, exported here so that components import from `fwk` alone."
    return f"::: {package}.{name}\n    options:\n      show_root_heading: false"
