"""Writes readable pages from the samples of a profiled component."""

from pathlib import Path

from fwk.host.profile import SUFFIX


def write_profiles(run_dir: Path) -> list[str]:
    """Writes each profile as text, as a page for the browser, and for speedscope; returns lines with their places."""
    return [_write(file) for file in sorted(run_dir.glob(f"profile-*{SUFFIX}"))] or [
        "no profile: the component finished no iteration"
    ]


def _write(file: Path) -> str:
    from pyinstrument.renderers import ConsoleRenderer, HTMLRenderer, SpeedscopeRenderer
    from pyinstrument.session import Session

    session = Session.load(file)
    pages = {
        ".txt": ConsoleRenderer(show_all=True),
        ".html": HTMLRenderer(show_all=True),
        ".speedscope.json": SpeedscopeRenderer(show_all=True),
    }
    for suffix, renderer in pages.items():
        file.with_suffix(suffix).write_text(renderer.render(session))
    return f"profile: {file.with_suffix('.txt')}, also {', '.join(list(pages)[1:])} and {SUFFIX}"
