"""Page of the devices: cameras, lasers, bases and whatever else has an instrument, and a pad to drive with."""

from typing import Any

from nicegui import ui

from fwk.web.device_view import devices_of
from fwk.web.driving import Deflection, Stick, Watchman, drives, members_of
from fwk.web.instruments import CAMERA
from fwk.web.layout import Frame, body
from fwk.web.recorded_link import RecordedLink
from fwk.web.run_link import RunLink

_LIST_S = 2.0
_PERIOD_S = 0.1
_IMAGE_S = 0.2
_WATCH_S = 0.1


def build(frame: Frame) -> None:
    """Makes the page."""
    chosen = frame.request.query_params.get("channel", "")
    with body(), ui.row().classes("w-full items-start"):
        with ui.column().classes("fwk-list"):
            wanted = ui.input("filter").props("dense outlined clearable").props("data-name=filter")
            columns = [
                {"name": key, "label": key, "field": key, "sortable": True, "align": "left"}
                for key in ("channel", "kind")
            ]
            table = ui.table(rows=[], columns=columns, row_key="channel").classes("fwk-table")
            table.props("dense flat bordered virtual-scroll").props("data-name=devices")
            table.bind_filter_from(wanted, "value")
        panel = ui.column().classes("fwk-half")
    with panel:
        ui.label("choose a device").classes("opacity-70")

    async def refresh() -> None:
        rows = [
            {"channel": channel, "kind": instrument.title}
            for channel, instrument in devices_of(await frame.link.types()).items()
        ]
        if rows != table.rows:
            table.rows = rows

    async def choose(channel: str) -> None:
        panel.clear()
        with panel:
            await show_device(frame, channel)

    table.on("row-click", lambda event: choose(event.args[1]["channel"]), [[], ["channel"], None])
    frame.every(_LIST_S, refresh)
    if chosen:
        ui.timer(0.1, lambda: frame.do(choose(chosen)), once=True)


async def show_device(frame: Frame, channel: str) -> None:
    """Makes the instrument of a device, and a pad if the channel may be written from outside."""
    members = await frame.do(_members(frame.link, channel)) or set()
    ui.label(channel).classes("text-subtitle1").props("data-name=device")
    headline = ui.label("").classes("fwk-value").props("data-name=reading")
    period_s = _IMAGE_S if CAMERA.members <= members else _PERIOD_S
    canvas = frame.canvas(channel, period_s, device=channel)
    canvas.classes("fwk-device").props(f'data-name="canvas {channel}"')
    canvas.on_headline(headline.set_text)
    rows = await frame.do(frame.link.channels()) or []
    if frame.may_steer and drives(members) and any(row["channel"] == channel and row["outside"] for row in rows):
        canvas.classes("fwk-driven")
        _pad(frame, channel, members)


async def _members(link: RunLink | RecordedLink, channel: str) -> set[str]:
    return {*(await link.message_type(channel)).__slots__}


def _pad(frame: Frame, channel: str, members: set[str]) -> None:
    """Makes the pad that writes a channel; it stops everything when its browser falls silent."""
    watchman = Watchman()
    with ui.row().classes("items-center gap-4"):
        stick = Stick(f"drive {channel}").props("data-name=stick")
        with ui.column().classes("gap-1"):
            ui.label("push the pad; or click it and hold W, S, A, D, Q, E, the arrows or digits").classes("opacity-70")
            speed = ui.number("speed in m/s", value=0.5, min=0.0, step=0.1).props("dense outlined")
            turn = ui.number("turn in rad/s", value=1.0, min=0.0, step=0.1).props("dense outlined")
            speed.set_visibility("axes" not in members)
            turn.set_visibility("axes" not in members)

    async def send(deflection: Deflection) -> Any:
        made = members_of(members, deflection, speed.value or 0.0, turn.value or 0.0)
        return await frame.do(frame.access.send(channel, made))

    async def take(deflection: Deflection) -> None:
        watchman.told(deflection)
        if await send(deflection) is None:
            watchman.told(Deflection())

    async def watch() -> None:
        if watchman.lets_go():
            await send(Deflection())

    stick.on_stick(take)
    ui.timer(_WATCH_S, watch)  # also while the page is hidden
