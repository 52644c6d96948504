"""Page of the blackboard: all channels with age and rate, and the newest message of one."""

import asyncio
from typing import Any

from nicegui import ui

from fwk.clock import monotonic_us
from fwk.control.client import ControlError
from fwk.web.instruments import CAMERA
from fwk.web.layout import Frame, body
from fwk.web.rates import Rates
from fwk.web.sending import Answers, send_form
from fwk.web.words import age, rows_of, seconds

_COLUMNS = {
    "channel": "channel",
    "rate": "Hz",
    "age": "age",
    "type": "type",
    "writer": "writer",
    "messages": "messages",
    "bytes": "bytes",
    "readers": "readers",
}
_WORDS = ("channel", "type", "writer", "readers")
_LIST_S = 2.0
_SHOW_S = 0.25
_IMAGE_S = 0.2


def build(frame: Frame) -> None:
    """Makes the page."""
    link = frame.link
    chosen = {"channel": frame.request.query_params.get("channel", "")}
    rates = Rates()
    with body(), ui.row().classes("w-full items-start"):
        with ui.column().classes("fwk-half"):
            wanted = ui.input("filter").props("dense outlined clearable").props("data-name=filter")
            columns = [
                {"name": key, "label": title, "field": key, "sortable": True, "align": _align(key)}
                for key, title in _COLUMNS.items()
            ]
            table = ui.table(rows=[], columns=columns, row_key="channel").classes("fwk-table")
            table.props("dense flat bordered virtual-scroll").props("data-name=channels").bind_filter_from(
                wanted, "value"
            )
        with ui.column().classes("fwk-half"):
            title = ui.label("choose a channel").classes("text-subtitle1").props("data-name=channel")
            form = ui.column().classes("w-full")  # live messages resize only what is below it: no click misses it
            answers = Answers()
            about = ui.label("").classes("opacity-70")
            image = ui.column().classes("w-full")
            fields = ui.table(
                rows=[],
                columns=[
                    {"name": "field", "label": "field", "field": "field", "align": "left"},
                    {"name": "value", "label": "value", "field": "value", "align": "left", "classes": "fwk-value"},
                ],
                row_key="field",
            )
            fields.props("dense flat bordered").classes("fwk-table").props("data-name=fields")

    async def refresh_list() -> None:
        rows = await link.channels()
        now = rates.measure(rows, monotonic_us())
        table.rows = [
            {**row_of(row), "rate": f"{rate_hz:.1f}" if rate_hz is not None else ""}
            for row in rows
            for rate_hz in [row.get("rate_hz", now.get(row["channel"]))]
        ]

    async def refresh_fields() -> None:
        if not chosen["channel"]:
            return
        try:
            answer = await link.show(chosen["channel"])
        except ControlError as error:
            about.set_text(str(error))
            return
        if answer["value"] is None:
            about.set_text(f"{answer['type']}: never written")
            fields.rows = []
            return
        about.set_text(
            f"{answer['type']}   sequence {answer['sequence']}   tick {answer['tick']}   "
            f"{seconds(answer['time_us'])}   by {answer['by']}   {age(answer['age_s'])} old"
        )
        members = {key: value for key, value in answer["value"].items() if key != "header" or answer["plain"]}
        shown = [{"field": name, "value": value} for name, value in rows_of("", members)]
        if shown != fields.rows:
            fields.rows = shown

    choosing = asyncio.Lock()

    async def choose(channel: str) -> None:
        chosen["channel"] = channel
        async with choosing:
            if chosen["channel"] == channel:
                await show_chosen(channel)

    async def show_chosen(channel: str) -> None:
        kind = (await link.types([channel])).get(channel)
        title.set_text(channel)
        image.clear()
        if kind and CAMERA.members <= {*kind.__slots__}:
            with image:
                frame.canvas(channel, _IMAGE_S, device=channel).classes("fwk-device")
        form.clear()
        with form:
            await send_form(frame, channel, answers)
        await refresh_fields()

    table.on("row-click", lambda event: choose(event.args[1]["channel"]), [[], ["channel"], None])
    frame.every(_LIST_S, refresh_list)
    frame.every(_SHOW_S, refresh_fields)
    if chosen["channel"]:
        ui.timer(0.1, lambda: frame.do(choose(chosen["channel"])), once=True)


def row_of(row: dict[str, Any]) -> dict[str, Any]:
    """Returns the row of a channel."""
    return {
        **{key: row[key] for key in ("channel", "type", "messages", "bytes")},
        "writer": row["writer"] or ("outside" if row["outside"] else ""),
        "age": age(row["age_s"]),
        "readers": ", ".join(row["readers"]),
    }


def _align(key: str) -> str:
    return "left" if key in _WORDS else "right"
