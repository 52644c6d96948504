"""Page of the recordings: all run directories, and one of them tick by tick."""

import asyncio
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

from nicegui import ui

from fwk.lcm.event_log import LogError
from fwk.recording.play.timeline import MomentError
from fwk.web.canvas import Canvas
from fwk.web.drawings import views_of_recording
from fwk.web.layout import Frame, body
from fwk.web.recorded import RecordedRun
from fwk.web.words import size

_COLUMNS = ("run", "ticks", "duration", "seed", "size", "result")
_PLAY_S = 0.1
_NOTES_MAX = 30


def build(frame: Frame) -> None:
    """Makes the page."""
    name = frame.request.query_params.get("log", "")
    with body():
        if name:
            area = ui.column().classes("w-full gap-1")
            ui.timer(0.1, lambda: _open(frame, area, name), once=True)
            return
        columns = [{"name": key, "label": key, "field": key, "sortable": True, "align": "left"} for key in _COLUMNS]
        rows = [row_of(each) for each in frame.console.recordings()]
        table = ui.table(rows=rows, columns=columns, row_key="run").props("dense flat bordered").classes("fwk-table")
        table.on("row-click", lambda event: _show(frame, event.args[1]["run"]), [[], ["run"], None])


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
        run = await asyncio.to_thread(frame.console.recorded, name)
        views = views_of_recording(frame.console, name)
    except (LogError, MomentError) as error:
        with area:
            ui.label(str(error)).classes("text-negative")
        return
    with area:
        _player(run, name, [view.title for view in views])


def _player(run: RecordedRun, name: str, titles: list[str]) -> None:
    """Shows one tick of a recording; the slider, the buttons and the notes lead to others."""
    ui.label(f"{name}: {run.last_tick} ticks, {run.info.events} messages, {size(run.info.size_bytes)}")
    with ui.row().classes("items-center w-full no-wrap"):
        view = ui.select(dict(enumerate(titles)), value=0).props('dense outlined aria-label="view"')
        back = ui.button(icon="skip_previous").props('flat dense aria-label="one tick back"')
        play = ui.button(icon="play_arrow").props('flat dense aria-label="play"')
        on = ui.button(icon="skip_next").props('flat dense aria-label="one tick on"')
        tick = ui.slider(min=1, max=max(1, run.last_tick), value=1).props('aria-label="tick"').classes("col")
        shown = ui.label("tick 1").classes("fwk-clock").props("data-name=tick")
    headline = ui.label("").classes("text-subtitle1").props("data-name=headline")
    canvas = Canvas(_address(name, 0, 1), f"recording {name}", _PLAY_S, False)
    canvas.on_headline(headline.set_text)
    with ui.row().classes("gap-1"):
        for note in run.info.notes[:_NOTES_MAX]:
            ui.button(f"{note.tick}: {note.text}", on_click=lambda note=note: tick.set_value(note.tick)).props(
                "outline dense no-caps size=sm"
            )
    with ui.row().classes("gap-4"):
        for line in (f"fwk replay {name} --verify", f"fwk play {name}", f"fwk log-info {name}"):
            ui.label(line).classes("fwk-value")

    def show() -> None:
        shown.set_text(f"tick {tick.value}")
        canvas.show(_address(name, int(view.value), int(tick.value)))

    def move(ticks: int) -> None:
        tick.set_value(min(run.last_tick, max(1, tick.value + ticks)))

    def advance() -> None:
        move(2)
        if tick.value >= run.last_tick:
            stop()

    def stop() -> None:
        timer.deactivate()
        play.props("icon=play_arrow")

    def toggle() -> None:
        if timer.active:
            stop()
        else:
            timer.activate()
            play.props("icon=pause")

    timer = ui.timer(_PLAY_S, advance, active=False)
    tick.on_value_change(show)
    view.on_value_change(show)
    back.on_click(lambda: move(-1))
    on.on_click(lambda: move(1))
    play.on_click(toggle)


def _address(name: str, view: int, tick: int) -> str:
    return f"/recorded?{urlencode({'log': name, 'view': view, 'tick': tick})}"
