"""Page of the runs: all runs of this machine side by side, and launch files to start."""

from pathlib import Path
from typing import Any

from nicegui import ui

from fwk.control.client import ControlError
from fwk.web.job_panel import JobPanel
from fwk.web.layout import Frame, body, state_of
from fwk.web.view import RunAccess
from fwk.web.words import seconds

_REFRESH_S = 1.0
_FOLDER = "launch"
_HOST = ".host.yaml"


def build(frame: Frame) -> None:
    """Makes the page."""
    cards: dict[str, ui.card] = {}
    with body():
        if frame.may_steer:
            _start(frame)
        area = ui.row().classes("w-full items-stretch").props("data-name=runs")
        with area:
            nothing = ui.label("nothing runs on this machine").classes("opacity-70")

    async def refresh() -> None:
        runs = await frame.console.runs.all()
        nothing.set_visibility(not runs)
        for name in [name for name in cards if name not in runs]:
            area.remove(cards.pop(name))
        for name in runs:
            if name not in cards:
                with area:
                    cards[name] = _card(frame, name)

    frame.every(_REFRESH_S, refresh)


def launch_files(folder: Path) -> list[str]:
    """Returns the launch files of a folder, without host-specific ones."""
    return sorted(file.name for file in (folder / _FOLDER).glob("*.yaml") if not file.name.endswith(_HOST))


def _start(frame: Frame) -> None:
    with ui.row().classes("items-center gap-2"):
        files = ui.select(launch_files(Path()), label="launch file", with_input=True)
        files.props("dense outlined").classes("w-72").props("data-name=file")
        name = ui.input("name of the run").props("dense outlined").props("data-name=run-name")
        button = ui.button("start", icon="play_arrow").props("dense outline no-caps data-name=launch")
    panel = JobPanel(frame)

    def start() -> None:
        if not files.value:
            ui.notify("choose a launch file first", type="warning")
            return
        own = ["--run", name.value] if name.value else []
        panel.start(["fwk-launch", files.value, "--detach", *own])

    button.on_click(start)


def _card(frame: Frame, name: str) -> ui.card:
    """Makes the card of a run."""
    link = frame.console.runs.link(name)
    access = RunAccess(link, frame.role)
    with ui.card().classes("fwk-card").props(f'data-name="run {name}"') as card:
        ui.link(name, f"/?run={name}").classes("text-h6")
        state = ui.label("").classes("fwk-state")
        figures = ui.label("").classes("fwk-clock")
        about = ui.label("").classes("opacity-70")
        if frame.may_steer:
            with ui.row().classes("gap-1"):
                for verb in ("pause", "resume", "step"):
                    fields: dict[str, Any] = {"ticks": 1} if verb == "step" else {}
                    button = ui.button(verb, on_click=lambda v=verb, f=fields: frame.do(access.clock(v, **f)))
                    button.props("dense outline no-caps size=sm")

        async def refresh() -> None:
            try:
                status = {**await link.status(2 * _REFRESH_S), **await link.clock()}
            except ControlError:
                return  # the card disappears with the run
            state.set_text(state_of(status))
            figures.set_text(
                f"tick {status['tick']}  {seconds(status['time_us'])}  {status['ticks_per_s']:.1f} ticks/s"
            )
            about.set_text(f"{status['plan']}, {len(status['components'])} components, {Path(status['run_dir']).name}")

        frame.every(_REFRESH_S, refresh)
    return card
