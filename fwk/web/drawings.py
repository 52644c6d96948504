"""Serves the drawings of views and the images of cameras.

A browser asks for a drawing after the last drawing was shown, so a sleeping browser costs nothing.
"""

import asyncio
from fnmatch import fnmatchcase
from typing import Any

import cv2
import numpy as np
from fastapi import FastAPI
from numpy.typing import NDArray
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response

from fwk.clock import monotonic_us
from fwk.component.images import Ring
from fwk.control.client import ControlError
from fwk.display.graph import graph
from fwk.display.graph_svg import svg
from fwk.lcm.event_log import LogError
from fwk.recording.play.timeline import MomentError
from fwk.web.console import Console
from fwk.web.device_view import DeviceView
from fwk.web.general_view import GeneralView
from fwk.web.rates import Rates
from fwk.web.scene import Drawing, Newest, Scene
from fwk.web.view import View

_DRAWING_AGE_S = 0.04
_IMAGE_AGE_S = 0.15
_LAG_PERIOD_MS = 300
"""Time from drawing to drawing while a run needs all processors."""
_NO_STORE = {"cache-control": "no-store"}


def add_drawings(app: FastAPI, console: Console) -> None:
    """Adds the addresses `/drawing` and `/image`."""

    async def drawing(request: Request) -> Response:
        run, number, device = (request.query_params.get(key, "") for key in ("run", "view", "device"))

        async def draw() -> Drawing:
            view = chosen(await views_of(console, run), number, device)
            newest = await console.runs.link(run).newest(view.channels, view.members)
            return await asyncio.to_thread(lambda: drawn(view, newest).drawing())

        try:
            found = await console.shared.get(("drawing", run, number, device), _DRAWING_AGE_S, draw)
            lags = await console.runs.link(run).lags()
        except ControlError as error:
            return PlainTextResponse(str(error), 503, _NO_STORE)
        return _answer(request, found, _LAG_PERIOD_MS if lags else 0)

    async def image(request: Request) -> Response:
        run, channel, frame = (request.query_params.get(key, "") for key in ("run", "channel", "frame"))
        number = int(frame) if frame.isdecimal() else 0
        try:
            pid = (await console.runs.link(run).about())["pid"]
            key = ("image", pid, channel, number)
            data = await console.shared.get(key, _IMAGE_AGE_S, lambda: asyncio.to_thread(_image, pid, channel, number))
        except ControlError as error:
            return PlainTextResponse(str(error), 503, _NO_STORE)
        if data is None:
            return PlainTextResponse(f"{channel}: no frame", 404, _NO_STORE)
        return Response(data, 200, _NO_STORE, "image/jpeg")

    async def graph_svg(request: Request) -> Response:
        link = console.runs.link(request.query_params.get("run", ""))
        around = request.query_params.get("around", "")
        try:
            status, channels = await link.status(), await link.channels()
        except ControlError as error:
            return PlainTextResponse(str(error), 503, _NO_STORE)
        rates = console.rates.setdefault(status["pid"], Rates()).measure(channels, monotonic_us())
        rows = [{**row, "rate_hz": rates.get(row["channel"], 0.0)} for row in channels]
        stages = dict.fromkeys((*status["order"], *(name for each in status["components"] for name in each["stages"])))
        used = [name for name in stages if any(name in each["stages"] for each in status["components"])]
        found = graph(status["plan"], used, status["components"], rows)
        return Response(svg(found.around([around]) if around else found), 200, _NO_STORE, "image/svg+xml")

    async def recorded(request: Request) -> Response:
        name, number, device, tick = (request.query_params.get(key, "") for key in ("log", "view", "device", "tick"))
        try:
            run = console.recorded(name)
            view = chosen(views_of_recording(console, name), number, device)
            newest = await asyncio.to_thread(run.newest, int(tick) if tick.isdecimal() else 1)
        except (LogError, MomentError) as error:
            return PlainTextResponse(str(error), 404, _NO_STORE)
        wanted = {channel: value for channel, value in newest.items() if wants(view, channel, value)}
        return _answer(request, await asyncio.to_thread(lambda: drawn(view, wanted).drawing()))

    async def recorded_image(request: Request) -> Response:
        try:
            run = console.recorded(request.query_params.get("log", ""))
        except LogError as error:
            return PlainTextResponse(str(error), 404, _NO_STORE)
        picture = run.picture(request.query_params.get("channel", ""))
        data = await asyncio.to_thread(_jpeg, picture.pixels()) if picture else None
        if data is None:
            return PlainTextResponse("no images of it in this recording", 404, _NO_STORE)
        return Response(data, 200, _NO_STORE, "image/jpeg")

    app.add_route("/recorded-image", recorded_image)
    app.add_route("/graph.svg", graph_svg)
    app.add_route("/recorded", recorded)
    app.add_route("/drawing", drawing)
    app.add_route("/image", image)


async def views_of(console: Console, run: str) -> list[View]:
    """Returns the views that are offered for a run: those of projects first."""
    channels = [row["channel"] for row in await console.runs.link(run).channels()]
    return [*console.extensions.views_for(channels), GeneralView()]


def views_of_recording(console: Console, name: str) -> list[View]:
    """Returns the views that are offered for a recording.

    Raises:
        LogError: it cannot be read.
    """
    return [*console.extensions.views_for(console.recorded(name).info.channels), GeneralView()]


def chosen(views: list[View], number: str, device: str) -> View:
    """Returns the view that an address names: that of a device or that of the number; otherwise the first."""
    if device:
        return DeviceView(device, views)
    return views[int(number) if number.isdecimal() and int(number) < len(views) else 0]


def wants(view: View, channel: str, value: Any) -> bool:
    """Tells whether a view draws a message."""
    named = any(fnmatchcase(channel, pattern) for pattern in view.channels)
    return named and {*view.members} <= {*value.__slots__}


def drawn(view: View, newest: dict[str, Any]) -> Scene:
    """Returns the drawing of a view; a view that fails shows its mistake."""
    scene = Scene()
    try:
        view.draw(Newest(newest), scene)
    except Exception as error:  # of a project's code; the page shows it
        scene = Scene()
        scene.headline = f"{type(view).__name__}: {type(error).__name__}: {error}"
    return scene


def _answer(request: Request, found: Drawing, period_ms: int = 0) -> Response:
    """Returns as much of a drawing as the browser does not have yet; `period_ms` asks it to wait for the next one."""
    about = {**_NO_STORE, "fwk-drawing": found.name, "fwk-period-ms": str(period_ms)}
    if request.query_params.get("have") == found.name:
        return Response(None, 204, about)
    return Response(found.beyond(request.query_params.get("ground", "")), 200, about, "application/json")


def _image(pid: int, channel: str, number: int) -> bytes | None:
    """Returns a frame of a camera as JPEG: that of the number if it is kept still, otherwise the newest."""
    ring = Ring.of_process(pid, channel)
    found = ring.newest(number) if ring else None
    return _jpeg(found[1]) if found else None


def _jpeg(pixels: NDArray[np.uint8] | None) -> bytes | None:
    if pixels is None:
        return None
    done, data = cv2.imencode(".jpg", pixels)
    return data.tobytes() if done else None
