"""Page of the log: filters, and following."""

import re
from typing import Any

from nicegui import ui

from fwk.component.log import LEVELS
from fwk.display.lines import log_line
from fwk.logs.reader import Filter, from_plain
from fwk.web.layout import Frame, body
from fwk.web.lines import Lines

_REFRESH_S = 0.4
_RANGE = re.compile(r"\s*(\d*)\s*(\.\.)?\s*(\d*)\s*", re.ASCII)
_TICK_MAX = 1 << 62


class FilterMistakeError(ValueError):
    """A field of the filters cannot be understood."""


def filter_of(level: str, component: str, ticks: str, file: str, text: str) -> Filter:
    """Returns the filter that a person has typed.

    Raises:
        FilterMistakeError: ticks or text are not understood.
    """
    try:
        pattern = re.compile(text, re.IGNORECASE) if text else None
    except re.error as error:
        raise FilterMistakeError(f"text: {error}") from error
    return Filter(level=level, component=component or None, tick=_ticks(ticks), file=file or None, text=pattern)


def _ticks(text: str) -> tuple[int, int] | None:
    if not text.strip():
        return None
    found = _RANGE.fullmatch(text)
    if not found or not (found[1] or found[3]) or (found[3] and not found[2]):
        raise FilterMistakeError("ticks: write N, A.., ..B or A..B")
    first = int(found[1] or 0)
    return first, int(found[3]) if found[3] else _TICK_MAX if found[2] else first


def build(frame: Frame) -> None:
    """Makes the page."""
    link = frame.link
    query = frame.request.query_params
    seen_dir, seen = "", 0
    with body():
        with ui.row().classes("items-center gap-2"):
            level = (
                ui.select(list(LEVELS), value="info", label="level").props("dense outlined").props("data-name=level")
            )
            component = ui.input("component or pattern", value=query.get("component", "")).props("data-name=component")
            ticks = ui.input("ticks A..B", value=query.get("tick", "")).props("data-name=ticks")
            file = ui.input("source file").props("data-name=file")
            text = ui.input("text (regular expression)").props("data-name=text")
            inputs: list[Any] = [component, ticks, file, text]
            for each in inputs:
                each.props("dense outlined clearable debounce=300")
            follow = ui.switch("follow", value=True).props("data-name=follow")
            mistake = ui.label("").classes("text-negative").props("data-name=mistake")
        if frame.may_steer:
            _note(frame)
        lines = Lines()
        lines.props("data-name=lines")
        lines.on("follow", lambda event: follow.set_value(event.args))
    follow.on_value_change(lambda event: lines.follow(event.value))

    def again() -> None:
        nonlocal seen
        seen = 0
        lines.clear_lines()

    for each in (level, *inputs):
        each.on_value_change(again)

    async def refresh() -> None:
        nonlocal seen_dir, seen
        run_dir = (await link.about())["run_dir"]
        if run_dir != seen_dir:
            seen_dir = run_dir
            again()
        try:
            typed = (each.value or "" for each in inputs)
            wanted = filter_of(level.value, *typed)
        except FilterMistakeError as error:
            mistake.set_text(str(error))
            return
        mistake.set_text("")
        found = frame.console.logs.of(run_dir).after(seen)
        if found:
            seen = found[-1][0]
            lines.append(
                [
                    (number, line["level"], log_line(from_plain(line)), line["tick"])
                    for number, line in found
                    if wanted.wants(line)
                ][-2000:]
            )

    frame.every(_REFRESH_S, refresh)


def _note(frame: Frame) -> None:
    async def write() -> None:
        if note.value and await frame.do(frame.access.note(note.value), "noted"):
            note.set_value("")

    note = (
        ui.input("note for the log; Enter writes it").props("dense outlined").classes("w-full").props("data-name=note")
    )
    note.on("keydown.enter", write)
