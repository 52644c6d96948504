"""Page of the log: filters, and following."""

import re
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

from nicegui import ui

from fwk.clock import US_PER_S
from fwk.component.log import LEVELS
from fwk.display.lines import log_line
from fwk.logs.reader import Filter, from_plain
from fwk.web.layout import Frame, body
from fwk.web.lines import Lines
from fwk.web.recorded_link import RecordedLink

_REFRESH_S = 0.4
_NUMBER = r"(\d+(?:\.\d+)?)?"
_RANGE = re.compile(rf"\s*{_NUMBER}\s*(\.\.)?\s*{_NUMBER}\s*", re.ASCII)
_PLACE = re.compile(r":\d+\s*$", re.ASCII)
_MOST = 1 << 62


class FilterMistakeError(ValueError):
    """A field of the filters cannot be understood."""


def filter_of(level: str, component: str, ticks: str, times: str, place: str, text: str) -> Filter:
    """Returns the filter that a person has typed.

    Args:
        level: least level.
        component: name or pattern; empty: all, as in the others.
        ticks: range `A..B`, `A..`, `..B` or one tick.
        times: the same of logical time in seconds.
        place: source file, perhaps with its line, such as `agent.py:41`.
        text: regular expression.

    Raises:
        FilterMistakeError: ticks, times or text are not understood.
    """
    try:
        pattern = re.compile(text, re.IGNORECASE) if text else None
    except re.error as error:
        raise FilterMistakeError(f"text: {error}") from error
    file, _, line = place.strip().rpartition(":") if _PLACE.search(place) else (place.strip(), "", "")
    return Filter(
        level=level,
        component=component or None,
        tick=_range("ticks", ticks, 1),
        time_us=_range("times", times, US_PER_S),
        file=file or None,
        line=int(line) if line else None,
        text=pattern,
    )


def _range(name: str, text: str, unit: int) -> tuple[int, int] | None:
    if not text.strip():
        return None
    found = _RANGE.fullmatch(text)
    if not found or not (found[1] or found[3]) or (found[3] and not found[2]):
        raise FilterMistakeError(f"{name}: write N, A.., ..B or A..B")
    first, last = (round(float(part) * unit) if part else 0 for part in (found[1], found[3]))
    return first, last if found[3] else _MOST if found[2] else first + unit - 1


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
            ticks = ui.input("ticks A..B", value="" if link.recorded else query.get("tick", "")).props(
                "data-name=ticks"
            )
            times = ui.input("seconds A..B").props("data-name=times")
            file = ui.input("source file, perhaps :line").props("data-name=file")
            text = ui.input("text (regular expression)").props("data-name=text")
            inputs: list[Any] = [component, ticks, times, file, text]
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

    frame.on_tick(again)

    async def refresh() -> None:
        nonlocal seen_dir, seen
        run_dir = (await link.about())["run_dir"]
        if run_dir != seen_dir:
            seen_dir = run_dir
            lines.link_ticks(f"/recordings?{urlencode({'log': Path(run_dir).name})}&tick=")
            again()
        try:
            typed = (each.value or "" for each in inputs)
            wanted = filter_of(level.value, *typed)
        except FilterMistakeError as error:
            mistake.set_text(str(error))
            return
        mistake.set_text("")
        last = link.tick if isinstance(link, RecordedLink) else _MOST
        found = frame.console.logs.of(run_dir).after(seen)
        if found:
            seen = found[-1][0]
            lines.append(
                [
                    (number, line["level"], log_line(from_plain(line)), line["tick"])
                    for number, line in found
                    if wanted.wants(line) and line["tick"] <= last
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
