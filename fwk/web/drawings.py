"""Serves the drawings of views and the images of cameras.

A browser asks for a drawing after the last drawing was shown, so a sleeping browser costs nothing.
"""

import asyncio
from collections.abc import Sequence
from contextlib import suppress
from functools import partial
from typing import Any

import cv2
import numpy as np
from fastapi import FastAPI
from numpy.typing import NDArray
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response

from fwk.clock import monotonic_us
from fwk.component.images import Ring
from fwk.control.client import ControlError, RefusedError
from fwk.display.graph import graph
from fwk.display.graph_svg import svg
from fwk.lcm.event_log import LogError
from fwk.recording.pictures import as_picture
from fwk.web.console import Console
from fwk.web.device_view import DeviceView
from fwk.web.general_view import GeneralView
from fwk.web.rates import Rates
from fwk.web.recorded_link import RecordedLink
from fwk.web.run_link import RunLink
from fwk.web.scene import Drawing, Newest, Scene
from fwk.web.view import View

_DRAWING_AGE_S = 0.04
_RECORDED_AGE_S = 1.0
_IMAGE_AGE_S = 0.15
_LAG_PERIOD_MS = 400
"""Time from drawing to drawing while a run is behind its desired speed."""
_FULL_SPEED_PERIOD_MS = 1000
"""Time from drawing to drawing while a run goes as fast as possible."""
_NO_STORE = {"cache-control": "no-store"}


def add_drawings(app: FastAPI, console: Console) -> None:
    """Adds the addresses `/drawing` and `/image`."""

    async def drawing(request: Request) -> Response:
        query = request.query_params
        number, device = query.get("view", ""), query.get("device", "")
        try:
            link = await asyncio.to_thread(console.link, query)

            async def draw() -> Drawing:
                view = chosen(await views_of(console, link), number, device)
                newest = await link.newest(view.channels, view.members)
                settings = await _settings(link, view.settings)
                return await asyncio.to_thread(lambda: drawn(view, newest, settings).drawing())

            if isinstance(link, RecordedLink):
                key = ("drawing", link.run.path, link.tick, number, device)
                return _answer(request, await console.shared.get(key, _RECORDED_AGE_S, draw))
            found = await console.shared.get(("drawing", link.name, number, device), _DRAWING_AGE_S, draw)
            lags, clock = await link.lags(), await link.clock()
        except ControlError as error:
            return PlainTextResponse(str(error), 503, _NO_STORE)
        except LogError as error:
            return PlainTextResponse(str(error), 404, _NO_STORE)
        full_speed = not clock["pace"]
        glides = not (full_speed or clock["paused"] or device)  # a run at full speed wants the processors
        period_ms = 0 if not lags else _FULL_SPEED_PERIOD_MS if full_speed else _LAG_PERIOD_MS
        return _answer(request, found, period_ms, glides)

    async def image(request: Request) -> Response:
        channel, frame = (request.query_params.get(key, "") for key in ("channel", "frame"))
        number = int(frame) if frame.isdecimal() else 0
        try:
            link = await asyncio.to_thread(console.link, request.query_params)
            if isinstance(link, RecordedLink):
                data = await asyncio.to_thread(_recorded_image, link, channel)
            else:
                pid = (await link.about())["pid"]
                key = ("image", pid, channel, number)
                make = partial(asyncio.to_thread, _image, pid, channel, number)
                data = await console.shared.get(key, _IMAGE_AGE_S, make)
        except ControlError as error:
            return PlainTextResponse(str(error), 503, _NO_STORE)
        except LogError as error:
            return PlainTextResponse(str(error), 404, _NO_STORE)
        if data is None:
            return PlainTextResponse(f"{channel}: no frame", 404, _NO_STORE)
        return Response(data, 200, _NO_STORE, "image/jpeg")

    async def graph_svg(request: Request) -> Response:
        around = request.query_params.get("around", "")
        try:
            link = await asyncio.to_thread(console.link, request.query_params)
            status, channels = await link.status(), await link.channels()
        except ControlError as error:
            return PlainTextResponse(str(error), 503, _NO_STORE)
        except LogError as error:
            return PlainTextResponse(str(error), 404, _NO_STORE)
        rates = console.rates.setdefault(status["pid"], Rates()).measure(channels, monotonic_us())
        rows = [{"rate_hz": rates.get(row["channel"], 0.0), **row} for row in channels]
        stages = dict.fromkeys((*status["order"], *(name for each in status["components"] for name in each["stages"])))
        used = [name for name in stages if any(name in each["stages"] for each in status["components"])]
        found = graph(status["plan"], used, status["components"], rows)
        return Response(svg(found.around([around]) if around else found), 200, _NO_STORE, "image/svg+xml")

    app.add_route("/graph.svg", graph_svg)
    app.add_route("/drawing", drawing)
    app.add_route("/image", image)


async def views_of(console: Console, link: RunLink | RecordedLink) -> list[View]:
    """Returns the views that are offered for a run or a recording: those of projects first."""
    channels = [row["channel"] for row in await link.channels()]
    return [*console.extensions.views_for(channels), GeneralView()]


def chosen(views: list[View], number: str, device: str) -> View:
    """Returns the view that an address names: that of a device or that of the number; otherwise the first."""
    if device:
        return DeviceView(device, views)
    return views[int(number) if number.isdecimal() and int(number) < len(views) else 0]


async def _settings(link: RunLink | RecordedLink, patterns: Sequence[str]) -> dict[tuple[str, str], Any]:
    """Returns the settings that match patterns: value by component and name."""
    found = {}
    for each in patterns:
        with suppress(RefusedError):  # no component has such settings
            found.update({(row["component"], row["setting"]): row["value"] for row in await link.settings([each])})
    return found


def drawn(view: View, newest: dict[str, Any], settings: dict[tuple[str, str], Any] | None = None) -> Scene:
    """Returns the drawing of a view; a view that fails shows its mistake."""
    scene = Scene()
    try:
        view.draw(Newest(newest, settings), scene)
    except Exception as error:  # of a project's code; the page shows it
        scene = Scene()
        scene.headline = f"{type(view).__name__}: {type(error).__name__}: {error}"
    return scene


def _answer(request: Request, found: Drawing, period_ms: int = 0, glides: bool = False) -> Response:
    """Returns as much of a drawing as the browser does not have yet.

    `period_ms` asks it to wait for the next one; with `glides` its shapes glide there from the drawing before.
    """
    about = {**_NO_STORE, "fwk-drawing": found.name, "fwk-period-ms": str(period_ms), "fwk-glides": str(int(glides))}
    if request.query_params.get("have") == found.name:
        return Response(None, 204, about)
    return Response(found.beyond(request.query_params.get("ground", "")), 200, about, "application/json")


def _image(pid: int, channel: str, number: int) -> bytes | None:
    """Returns a frame of a camera as JPEG: that of the number if it is kept still, otherwise the newest."""
    ring = Ring.of_process(pid, channel)
    found = ring.newest(number) if ring else None
    return _jpeg(found[1]) if found else None


def _recorded_image(link: RecordedLink, channel: str) -> bytes | None:
    """Returns the image of a camera at the tick of a recording as JPEG."""
    picture = link.run.picture(channel, link.tick)
    return _jpeg(picture.pixels()) if picture else None


def _jpeg(pixels: NDArray[np.uint8] | None) -> bytes | None:
    if pixels is None:
        return None
    done, data = cv2.imencode(".jpg", as_picture(pixels))
    return data.tobytes() if done else None
