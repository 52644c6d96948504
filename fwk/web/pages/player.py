"""Player of a recording: one tick of it in drawings, instruments, fields and log lines; and work on all of it."""

import asyncio
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

from nicegui import ui

from fwk.display.lines import log_line
from fwk.lcm import messages
from fwk.logs.json_lines import FILE
from fwk.logs.reader import from_plain, read_lines
from fwk.web.canvas import Canvas
from fwk.web.instruments import instrument_of
from fwk.web.job_panel import JobPanel
from fwk.web.layout import Frame
from fwk.web.lines import Lines
from fwk.web.recorded import RecordedRun
from fwk.web.words import rows_of, size

_PLAY_S = 0.1
_SHOW_S = 0.3
_NOTES_MAX = 30
_LINES_MAX = 200
_LINES_BACK = 20
_FIELDS = (("field", "fwk-value"), ("value", "fwk-value"))


class Player:
    """Shows one tick of a recording; slider, buttons, bookmarks and lines of the log lead to others.

    Args:
        frame: the open page.
        run: the recording.
        name: name of its run directory.
        titles: titles of the views that can draw it.
        others: names of the other recordings, to compare with.
    """

    def __init__(self, frame: Frame, run: RecordedRun, name: str, titles: list[str], others: list[str]) -> None:
        self._run, self._name = run, name
        self._shown = (0, "")
        asked = frame.request.query_params.get("tick", "")
        tick = min(max(1, int(asked)), run.last_tick) if asked.isdecimal() else 1
        ui.label(f"{name}: {run.last_tick} ticks, {run.info.events} messages, {size(run.info.size_bytes)}")
        self._build_controls(titles, tick)
        if frame.may_steer:
            self._build_work(frame, others)
        with ui.row().classes("w-full items-start"):
            with ui.column().classes("fwk-recorded gap-1"):
                self._headline = ui.label("").classes("text-subtitle1").props("data-name=headline")
                self._canvas = Canvas(self._address(), f"recording {name}", _PLAY_S, images=self._images())
                self._canvas.on_headline(self._headline.set_text)
            self._build_channel()
        with ui.expansion("log at this tick", value=True).classes("w-full"):
            self._lines = Lines()
            self._lines.classes("fwk-output").props("data-name=log")
        self._build_moves()
        self._log: list[dict[str, Any]] | None = None
        ui.timer(_SHOW_S, self._show_details)

    @property
    def tick(self) -> int:
        """The tick that is shown."""
        return int(self._tick.value)

    def _build_controls(self, titles: list[str], tick: int) -> None:
        last = max(1, self._run.last_tick)
        with ui.row().classes("items-center w-full no-wrap"):
            self._view = ui.select(dict(enumerate(titles)), value=0).props('dense outlined aria-label="view"')
            self._back = ui.button(icon="skip_previous").props('flat dense aria-label="one tick back"')
            self._play = ui.button(icon="play_arrow").props('flat dense aria-label="play"')
            self._on = ui.button(icon="skip_next").props('flat dense aria-label="one tick on"')
            self._tick = ui.slider(min=1, max=last, value=tick).props('aria-label="tick"').classes("col")
            self._clock = ui.label(f"tick {tick}").classes("fwk-clock").props("data-name=tick")
        with ui.row().classes("gap-1"):
            for note in self._run.info.notes[:_NOTES_MAX]:
                button = ui.button(f"{note.tick}: {note.text}", icon="bookmark")
                button.on_click(lambda note=note: self._tick.set_value(note.tick)).props(
                    "outline dense no-caps size=sm"
                )

    def _build_channel(self) -> None:
        """Makes the panel with instrument and fields of one channel."""
        channels = sorted(each for each in self._run.info.channels if not each.startswith("fwk/"))
        with ui.column().classes("fwk-half gap-1"):
            self._channel = ui.select(channels, label="channel", with_input=True, clearable=True)
            self._channel.props("dense outlined").classes("w-full").props("data-name=channel")
            self._device = Canvas(self._address(), "instrument", _PLAY_S, images=self._images())
            self._device.classes("fwk-device").set_visibility(False)
            columns = [
                {"name": key, "label": key, "field": key, "align": "left", "classes": look} for key, look in _FIELDS
            ]
            self._fields = ui.table(rows=[], columns=columns, row_key="field").classes("fwk-table")
            self._fields.props("dense flat bordered").props("data-name=fields").set_visibility(False)

    def _build_moves(self) -> None:
        timer = ui.timer(_PLAY_S, lambda: self._advance(stop), active=False)

        def stop() -> None:
            timer.deactivate()
            self._play.props("icon=play_arrow")

        def toggle() -> None:
            if timer.active:
                stop()
            else:
                timer.activate()
                self._play.props("icon=pause")

        self._tick.on_value_change(self._show)
        self._view.on_value_change(self._canvas.fit_again)
        self._view.on_value_change(self._show)
        self._channel.on_value_change(self._device.fit_again)
        self._back.on_click(lambda: self._move(-1))
        self._on.on_click(lambda: self._move(1))
        self._play.on_click(toggle)

    def _build_work(self, frame: Frame, others: list[str]) -> None:
        """Makes the buttons for work on the whole recording, in child processes."""
        with ui.row().classes("items-center gap-2"):
            verify = ui.button("verify", icon="verified").props("dense outline no-caps")
            other = ui.select(others, label="other recording", with_input=True).props("dense outlined").classes("w-72")
            compare = ui.button("compare", icon="compare_arrows").props("dense outline no-caps")
            changes = ui.input("settings after the branch, NAME.SETTING=VALUE").props("dense outlined").classes("w-72")
            branch = ui.button("branch from this tick", icon="call_split").props("dense outline no-caps")
        panel = JobPanel(frame)

        def go_on_live() -> None:
            sets = [word for each in (changes.value or "").split() for word in ("--set", each)]
            panel.start(["fwk", "replay", self._name, "--to-tick", str(self.tick), "--then-live", *sets])

        def compare_with() -> None:
            if other.value:
                panel.start(["fwk", "compare", self._name, other.value, "--common"])
            else:
                ui.notify("choose the other recording first", type="warning")

        verify.on_click(lambda: panel.start(["fwk", "replay", self._name, "--verify"]))
        compare.on_click(compare_with)
        branch.on_click(go_on_live)

    def _move(self, ticks: int) -> None:
        self._tick.set_value(min(self._run.last_tick, max(1, self.tick + ticks)))

    def _advance(self, stop: Callable[[], None]) -> None:
        self._move(2)
        if self.tick >= self._run.last_tick:
            stop()

    def _show(self) -> None:
        self._clock.set_text(f"tick {self.tick}")
        self._canvas.show(self._address(view=self._view.value), self._images())

    async def _show_details(self) -> None:
        """Shows fields and log lines of the tick, less often than drawings."""
        now = (self.tick, self._channel.value or "")
        if now == self._shown:
            return
        if self._log is None:
            self._log = await asyncio.to_thread(_log_of, self._run.path.parent)
        self._shown = now
        tick, channel = now
        message = (await asyncio.to_thread(self._run.newest, tick)).get(channel) if channel else None
        instrument = message is not None and instrument_of(message.__slots__) is not None
        self._device.set_visibility(instrument)
        if instrument:
            self._device.show(self._address(device=channel), self._images())
        self._fields.set_visibility(message is not None)
        if message is not None:
            self._fields.rows = [
                {"field": name, "value": value} for name, value in rows_of("", messages.to_dict(message))
            ]
        self._lines.clear_lines()
        near = [line for line in self._log if tick - _LINES_BACK <= line["tick"] <= tick][-_LINES_MAX:]
        self._lines.append(
            [(number, line["level"], log_line(from_plain(line)), line["tick"]) for number, line in enumerate(near)]
        )

    def _address(self, **fields: Any) -> str:
        return f"/recorded?{urlencode({'log': self._name, 'tick': self.tick, **fields})}"

    def _images(self) -> str:
        return f"/recorded-image?{urlencode({'log': self._name})}"


def _log_of(folder: Path) -> list[dict[str, Any]]:
    """Returns the lines of the log for programs of a run; none if it has no such log."""
    try:
        return list(read_lines(folder / FILE))
    except OSError:
        return []
