"""Serves the console: pages of NiceGUI behind the gate."""

import asyncio
import socket
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import uvicorn
from fastapi import FastAPI
from nicegui import app as pages_app
from nicegui import ui
from starlette.requests import Request

from fwk.lcm.event_log import LogError
from fwk.web.access import Access, Gate, Role
from fwk.web.background import give_way
from fwk.web.console import Console
from fwk.web.drawings import add_drawings
from fwk.web.extensions import Extensions
from fwk.web.job import keep_priority
from fwk.web.layout import OF_RUNS, Frame
from fwk.web.log_tail import LogTails
from fwk.web.pages import board, devices, graph, log, plots, recordings, runs, settings, system, view
from fwk.web.run_link import Runs
from fwk.web.shared import Shared

_RECONNECT_S = 30.0
"""A page survives so long without a sign of life, on a busy machine or while the browser sleeps; then it loads anew."""
_BUILD_S = 120.0
"""Longest time in which a page is made: on a machine without an idle processor a page is late rather than missing."""
_BUILDERS: dict[str, Callable[[Frame], None]] = {
    "/": system.build,
    "/view": view.build,
    "/board": board.build,
    "/devices": devices.build,
    "/graph": graph.build,
    "/plots": plots.build,
    "/settings": settings.build,
    "/log": log.build,
    "/recordings": recordings.build,
    "/runs": runs.build,
}

_WITHOUT_RUN = ("/recordings", "/runs")
"""Pages that show something when nothing runs."""


@dataclass(frozen=True)
class Options:
    """Options of the console's server."""

    access: Access
    run: str = ""
    """Run that pages show at first."""
    modules: tuple[str, ...] = ()
    """Further modules with views and pages."""
    certificate: Path | None = None
    key: Path | None = None
    normal_priority: bool = False
    """Whether the console competes with runs for the processors."""


def serve(options: Options, listener: socket.socket, recordings: Callable[[], list[dict[str, Any]]]) -> None:
    """Serves the console until a signal ends it.

    Raises:
        ExtensionError: a module with views and pages cannot be used.
    """
    keep_priority()
    if not options.normal_priority:
        give_way()
    shared = Shared()
    extensions = Extensions(options.modules, Path())
    console = Console(Runs(shared), shared, extensions, LogTails(), recordings, options.run)
    app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None)
    add_drawings(app, console)
    _add_pages(console)
    ui.run_with(
        app,
        title="fwk",
        dark=None,
        show_welcome_message=False,
        binding_refresh_interval=0.2,
        reconnect_timeout=_RECONNECT_S,
        message_history_length=100,
    )
    encryption: dict[str, Any] = {}
    if options.certificate and options.key:
        encryption = {"ssl_certfile": str(options.certificate), "ssl_keyfile": str(options.key)}
    config = uvicorn.Config(
        Gate(app, options.access),
        log_level="warning",
        access_log=False,
        proxy_headers=False,
        server_header=False,
        timeout_graceful_shutdown=1,
        **encryption,
    )
    with suppress(KeyboardInterrupt):  # raised again after the server has ended
        uvicorn.Server(config).run(sockets=[listener])


def _add_pages(console: Console) -> None:
    pages_app.on_exception(lambda _: None)  # NiceGUI has logged it
    for path, builder in _BUILDERS.items():
        _add_page(console, path, builder)
    own = {f"/own/{page.path}": page for page in console.extensions.pages}
    for path, page in own.items():
        _add_page(console, path, page.build)


def _add_page(console: Console, path: str, builder: Callable[[Frame], Any]) -> None:
    async def made(request: Request) -> None:
        known = await console.runs.all()
        run = request.query_params.get("run") or console.run or next(iter(known), "")
        role: Role = request.state.role
        try:
            query = {} if path in OF_RUNS else request.query_params
            link = await asyncio.to_thread(console.link, query, run, True)
        except LogError as error:
            ui.label(str(error)).classes("q-pa-md text-negative")
            return
        frame = Frame(console, request, role, link, known)
        frame.build(path, await _own_pages(console, frame))
        if frame.run or path in _WITHOUT_RUN:
            builder(frame)
        else:
            ui.label(
                "nothing runs on this machine; the page Runs starts launch files, and so does: fwk-launch FILE"
            ).classes("q-pa-md")

    ui.page(path, response_timeout=_BUILD_S)(made)


async def _own_pages(console: Console, frame: Frame) -> dict[str, tuple[str, str]]:
    """Returns the pages of projects that this run has the channels for."""
    if not frame.run or not console.extensions.pages:
        return {}
    with suppress(Exception):
        channels = [row["channel"] for row in await frame.link.channels()]
        return {f"/own/{each.path}": (each.title, each.icon) for each in console.extensions.pages_for(channels)}
    return {}
