"""Player of a recording: the tick of the page in drawings, instruments, fields and log lines; and work on the whole."""

import asyncio
from pathlib import Path
from typing import Any

from nicegui import ui

from fwk.display.lines import log_line
from fwk.lcm import messages
from fwk.logs.json_lines import FILE
from fwk.logs.reader import from_plain, read_lines
from fwk.web.access import Role
from fwk.web.canvas import Canvas
from fwk.web.instruments import instrument_of
from fwk.web.job_panel import JobPanel
from fwk.web.layout import Frame
from fwk.web.lines import Lines
from fwk.web.recorded_link import RecordedLink
from fwk.web.words import options_of, rows_of, size

_DRAW_S = 0.1
_SHOW_S = 0.3
_NOTES_MAX = 30
_LINES_MAX = 200
_LINES_BACK = 20
_FIELDS = (("field", "fwk-value"), ("value", "fwk-value"))


class Player:
    """Shows the chosen tick of a recording; bookmarks and lines of the log lead to others.

    Args:
        frame: the open page.
        link: the recording.
        titles: titles of the views that can draw it.
        others: names of the other recordings, to compare with.
    """

    def __init__(self, frame: Frame, link: RecordedLink, titles: list[str], others: list[str]) -> None:
        self._frame, self._link = frame, link
        self._shown = (0, "")
        info = link.run.info
        ui.label(f"{link.name}: {link.run.last_tick} ticks, {info.events} messages, {size(info.size_bytes)}")
        with ui.row().classes("gap-1"):
            view = ui.select(dict(enumerate(titles)), value=0).props('dense outlined aria-label="view"')
            for note in info.notes[:_NOTES_MAX]:
                button = ui.button(f"{note.tick}: {note.text}", icon="bookmark")
                button.on_click(lambda note=note: frame.go(note.tick)).props("outline dense no-caps size=sm")
        if frame.role is Role.STEER:
            self._build_work(others)
        with ui.row().classes("w-full items-start"):
            with ui.column().classes("fwk-recorded gap-1"):
                headline = ui.label("").classes("text-subtitle1").props("data-name=headline")
                area = ui.column().classes("w-full")

                def show_view() -> None:
                    area.clear()
                    with area:
                        canvas = frame.canvas(f"recording {link.name}", _DRAW_S, view=str(view.value))
                        canvas.on_headline(headline.set_text)

                view.on_value_change(show_view)
                show_view()
            self._build_channel()
        with ui.expansion("log at this tick", value=True).classes("w-full"):
            self._lines = Lines()
            self._lines.classes("fwk-output").props("data-name=log")
        self._log: list[dict[str, Any]] | None = None
        frame.every(_SHOW_S, self._show_details)

    def _build_channel(self) -> None:
        """Makes the panel with instrument and fields of one channel."""
        channels = sorted(each for each in self._link.run.info.channels if not each.startswith("fwk/"))
        with ui.column().classes("fwk-half gap-1"):
            self._channel = ui.select(channels, label="channel", with_input=True, clearable=True)
            self._channel.props("dense outlined").classes("w-full").props("data-name=channel")
            self._instrument = ui.column().classes("w-full")
            self._device: Canvas | None = None
            self._channel.on_value_change(self._drop_device)
            columns = [
                {"name": key, "label": key, "field": key, "align": "left", "classes": look} for key, look in _FIELDS
            ]
            self._fields = ui.table(rows=[], columns=columns, row_key="field").classes("fwk-table")
            self._fields.props("dense flat bordered").props("data-name=fields").set_visibility(False)

    def _build_work(self, others: list[str]) -> None:
        """Makes the buttons for work on the whole recording, in child processes."""
        name = self._link.name
        with ui.row().classes("items-center gap-2"):
            verify = ui.button("verify", icon="verified").props("dense outline no-caps")
            other = ui.select(others, label="other recording", with_input=True).props("dense outlined").classes("w-72")
            compare = ui.button("compare", icon="compare_arrows").props("dense outline no-caps")
            changes = ui.input("settings after the branch, NAME.SETTING=VALUE").props("dense outlined").classes("w-72")
            branch = ui.button("branch from this tick", icon="call_split").props("dense outline no-caps")
        panel = JobPanel(self._frame)

        async def find_branch() -> None:
            other.set_options(await others_of(self._frame, name))

        def go_on_live() -> None:
            try:
                sets = options_of(changes.value or "")
            except ValueError as error:
                ui.notify(f"settings: {error}; quote a value with spaces: 'NAME.SETTING=[1, 2]'", type="warning")
                return
            words = ["fwk", "replay", name, "--to-tick", str(self._link.tick), "--then-live", *sets]
            panel.start(words, find_branch)

        def compare_with() -> None:
            if other.value:
                panel.start(["fwk", "compare", name, other.value, "--common"])
            else:
                ui.notify("choose the other recording first", type="warning")

        verify.on_click(lambda: panel.start(["fwk", "replay", name, "--verify"]))
        compare.on_click(compare_with)
        branch.on_click(go_on_live)

    def _drop_device(self) -> None:
        self._instrument.clear()
        self._device = None

    async def _show_details(self) -> None:
        """Shows fields and log lines of the tick, less often than drawings."""
        now = (self._link.tick, self._channel.value or "")
        if now == self._shown:
            return
        if self._log is None:
            self._log = await asyncio.to_thread(_log_of, self._link.run.path.parent)
        self._shown = now
        tick, channel = now
        message = (await self._link.newest([channel])).get(channel) if channel else None
        if message is not None and self._device is None and instrument_of(message.__slots__):
            with self._instrument:
                self._device = self._frame.canvas("instrument", _DRAW_S, device=channel).classes("fwk-device")
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


async def others_of(frame: Frame, name: str) -> list[str]:
    """Returns the names of the recordings except one."""
    names = [Path(each["path"]).name for each in await asyncio.to_thread(frame.console.recordings)]
    return [each for each in names if each != name]


def _log_of(folder: Path) -> list[dict[str, Any]]:
    """Returns the lines of the log for programs of a run; none if it has no such log."""
    try:
        return list(read_lines(folder / FILE))
    except OSError:
        return []
