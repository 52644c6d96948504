"""Page of the recordings: all run directories, and one of them tick by tick."""

import asyncio
from pathlib import Path
from typing import Any

from nicegui import ui

from fwk.lcm.event_log import LogError
from fwk.recording.play.timeline import MomentError
from fwk.web.drawings import views_of_recording
from fwk.web.layout import Frame, body
from fwk.web.pages.player import Player
from fwk.web.words import size

_COLUMNS = ("run", "ticks", "duration", "seed", "size", "result")
_LIST_S = 5.0


def build(frame: Frame) -> None:
    """Makes the page."""
    name = frame.request.query_params.get("log", "")
    with body():
        if name:
            area = ui.column().classes("w-full gap-1")
            ui.timer(0.1, lambda: _open(frame, area, name), once=True)
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
    ui.navigate.to(frame.address("/recordings", log=name))


async def _open(frame: Frame, area: ui.column, name: str) -> None:
    try:
        run = await asyncio.to_thread(frame.console.recorded, name, True)
        views = views_of_recording(frame.console, name)
    except (LogError, MomentError) as error:
        with area:
            ui.label(str(error)).classes("text-negative")
        return
    others = [Path(each["path"]).name for each in await asyncio.to_thread(frame.console.recordings)]
    with area:
        Player(frame, run, name, [view.title for view in views], [each for each in others if each != name])
