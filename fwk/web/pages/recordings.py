"""Page of the recordings: all run directories, and one of them tick by tick."""

import asyncio
from pathlib import Path
from typing import Any

from nicegui import ui

from fwk.web.drawings import views_of
from fwk.web.layout import Frame, body
from fwk.web.pages.player import Player, others_of
from fwk.web.recorded_link import RecordedLink
from fwk.web.words import size

_COLUMNS = ("run", "ticks", "duration", "seed", "size", "result")
_LIST_S = 5.0


def build(frame: Frame) -> None:
    """Makes the page."""
    link = frame.link
    with body():
        if isinstance(link, RecordedLink):
            area = ui.column().classes("w-full gap-1")
            ui.timer(0.1, lambda: _open(frame, area, link), once=True)
            return
        columns = [{"name": key, "label": key, "field": key, "sortable": True, "align": "left"} for key in _COLUMNS]
        wanted = ui.input("filter").props("dense outlined clearable").props("data-name=filter")
        table = ui.table(rows=[], columns=columns, row_key="run").props("dense flat bordered").classes("fwk-table")
        table.bind_filter_from(wanted, "value")
        table.on("row-click", lambda event: _show(frame, event.args[1]["run"]), [[], ["run"], None])

    async def refresh() -> None:
        rows = [row_of(each) for each in await asyncio.to_thread(frame.console.recordings)]
        if rows != table.rows:
            table.rows = rows

    frame.every(_LIST_S, refresh)


def row_of(found: dict[str, Any]) -> dict[str, Any]:
    """Returns the row of a run directory."""
    duration_s = found["duration_s"]
    return {
        "run": Path(found["path"]).name,
        "ticks": "" if found["ticks"] is None else str(found["ticks"]),
        "duration": "" if duration_s is None else f"{duration_s:.1f} s",
        "seed": "" if found["seed"] is None else str(found["seed"]),
        "size": size(found["size_bytes"]),
        "result": "runs" if found["in_use"] else found["result"],
    }


def _show(frame: Frame, name: str) -> None:
    ui.navigate.to(frame.address("/recordings", run="", log=name))


async def _open(frame: Frame, area: ui.column, link: RecordedLink) -> None:
    views = await views_of(frame.console, link)
    others = await others_of(frame, link.name)
    with area:
        Player(frame, link, [view.title for view in views], others)
