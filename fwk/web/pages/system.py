"""Page of the components: state, times, losses; start, stop, restart, reload, log level."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from nicegui import ui

from fwk.clock import US_PER_S, monotonic_us, rate_word, turns_word
from fwk.control.requests import Action
from fwk.model.histogram import Histogram
from fwk.web.layout import Frame, body
from fwk.web.usage import Figures
from fwk.web.words import age, rows_of

ACTIONS: dict[Action, str] = {
    "start": "play_arrow",
    "stop": "stop",
    "restart": "restart_alt",
    "reload": "sync",
    "load": "file_download",
    "unload": "eject",
    "kill": "dangerous",
}
LEVELS = ("debug", "info", "warning", "error")
_COLUMNS = {
    "name": "component",
    "state": "state",
    "stage": "stage",
    "pid": "pid",
    "cpu": "CPU %",
    "memory": "MB",
    "starts": "starts",
    "iterations": "iterations",
    "mean_ms": "mean ms",
    "worst_ms": "worst ms",
    "fetched": "fetched",
    "lost": "lost",
    "reason": "reason",
}
_WORDS = ("name", "state", "stage", "reason")
_STATE_CELL = '<q-td :props="props"><span :class="`s-${props.value}`">{{ props.value }}</span></q-td>'
_USAGE_S = 2.0
_FIGURES_US = 2 * US_PER_S
"""Figures are shown anew so often, states at once: a browser needs long to draw a hundred rows."""
_LAG_FACTOR = 4
"""Figures are shown so many times more rarely while the run needs all processors."""


def build(frame: Frame) -> None:
    """Makes the page."""
    shown_us = 0
    usage: dict[int, Figures] = {}
    with body():
        figures = ui.label("").props("data-name=figures")
        with ui.row().classes("items-center gap-1"):
            wanted = ui.input("filter").props("dense outlined clearable").props("data-name=filter")
            chosen: list[str] = []
            buttons = _buttons(frame, chosen)
        columns = [
            {"name": key, "label": title, "field": key, "sortable": True, "align": "left" if key in _WORDS else "right"}
            for key, title in _COLUMNS.items()
        ]
        table = ui.table(rows=[], columns=columns, row_key="name", selection="multiple").classes("fwk-table")
        table.props("dense flat bordered binary-state-sort virtual-scroll").props("data-name=components")
        table.bind_filter_from(wanted, "value")
        table.add_slot("body-cell-state", _STATE_CELL)
        table.on("row-click", lambda event: _open(frame, event.args[1]["name"]), [[], ["name"], None])
        table.on_select(lambda event: choose([row["name"] for row in event.selection]))

    def choose(names: list[str]) -> None:
        chosen[:] = names
        for each in buttons:
            each.set_enabled(bool(names))

    def show(status: dict[str, Any]) -> None:
        nonlocal shown_us
        least_us = _FIGURES_US * (_LAG_FACTOR if frame.lags else 1)
        rows = [row_of(each, usage) for each in status["components"]]
        if states_of(rows) != states_of(table.rows) or monotonic_us() > shown_us + least_us:
            table.rows, shown_us = rows, monotonic_us()
        figures.set_text(
            f"{len(rows)} components   {status['ticks_per_s']:.1f} ticks/s   late {status['late']}   "
            f"repeated {status['repeated']}   {Path(status['run_dir']).name}"
        )

    async def measure() -> None:
        nonlocal shown_us
        first = not usage
        pids = {each["pid"] for each in (await frame.link.status())["components"]}
        usage.update(await frame.console.usage(frame.run, pids))
        shown_us = 0 if first else shown_us

    frame.on_status(show)
    frame.every(_USAGE_S, measure)


def row_of(component: dict[str, Any], usage: Mapping[int, Figures]) -> dict[str, Any]:
    """Returns the row of a component; CPU and memory are those of its process."""
    figures = usage.get(component["pid"])
    stage = ", ".join(component["stages"]) + turns_word(component["every"], component["offset"])
    if component["rate_hz"] is not None:
        stage = rate_word(component["rate_hz"])
    return {
        **{key: component[key] for key in _COLUMNS if key in component},
        "cpu": round(figures.cpu_percent, 1) if figures else "",
        "memory": round(figures.memory_mb, 1) if figures else "",
        "stage": stage,
        "mean_ms": round(component["mean_ms"], 2),
        "worst_ms": round(component["worst_ms"], 1),
    }


def states_of(rows: list[dict[str, Any]]) -> list[tuple[str, ...]]:
    """Returns the part of the rows whose changes are shown at once."""
    return [(row["name"], row["state"], row["reason"]) for row in rows]


def _buttons(frame: Frame, chosen: list[str]) -> list[ui.button]:
    if not frame.may_steer:
        return []

    async def steer(action: Action) -> None:
        if chosen:
            answer = await frame.do(frame.access.steer(action, list(chosen), force.value))
            if answer:
                ui.notify("; ".join(sentence(each, answer["tick"]) for each in answer["processes"]), type="info")

    made = []
    for action, icon in ACTIONS.items():
        button = ui.button(action, icon=icon, on_click=lambda action=action: steer(action))
        made.append(button.props("dense outline no-caps size=sm").props(f"data-name={action}"))
        button.set_enabled(False)
    force = ui.checkbox("stop and unload with all that need it").props("dense").classes("q-ml-sm")
    return made


def sentence(process: dict[str, Any], tick: int) -> str:
    """Returns the new state of a process as a sentence."""
    reason = f": {process['reason']}" if process["reason"] else ""
    return f"{process['name']} {process['state']}, tick {tick}{reason}"


async def _open(frame: Frame, name: str) -> None:
    """Shows everything about one component."""
    link, access = frame.link, frame.access
    status = await frame.do(link.status())
    component = next((each for each in (status or {}).get("components", []) if each["name"] == name), None)
    if component is None:
        return
    dialog = ui.dialog()
    dialog.on("hide", dialog.delete)
    with dialog, ui.card().classes("fwk-component").style("min-width: min(560px, 92vw)"):
        with ui.row().classes("items-center w-full"):
            ui.label(name).classes("text-h6")
            ui.space()
            ui.button(icon="close", on_click=dialog.close).props('flat dense aria-label="close"')
        if frame.may_steer:
            level = ui.select(list(LEVELS), label="log level", value=await _level(frame, name))
            level.on_value_change(lambda event: frame.do(access.set([f"{name}.log_level={event.value}"]), "changed"))
            level.classes("w-40").props("data-name=log-level")
        with ui.row().classes("items-center no-wrap"):
            line = f"fwk debug {name} --run {frame.run}"
            ui.label(line).classes("fwk-value")
            copy = ui.button(icon="content_copy").props('flat dense aria-label="copy the line"')
            copy.on("click", js_handler=f"() => navigator.clipboard.writeText({json.dumps(line)})")
        await _histogram(frame, name)
        with ui.grid(columns="auto 1fr").classes("gap-x-4 gap-y-0"):
            for key, value in rows_of("", {**component, "awake_s": age(component["awake_s"])}):
                ui.label(key).classes("opacity-70")
                ui.label(value).classes("fwk-value")
    dialog.open()


async def _level(frame: Frame, name: str) -> str | None:
    rows = await frame.do(frame.link.settings([f"{name}.log_level"]))
    value = rows[0]["value"] if rows else None
    return value if value in LEVELS else None


async def _histogram(frame: Frame, name: str) -> None:
    """Shows how long the iterations of a component take."""
    times = await frame.do(frame.link.times())
    if not times or name not in times["components"]:
        return
    histogram = Histogram.from_json(times["components"][name])
    rows = histogram.rows()
    percentiles = [f"p{each} {histogram.percentile_us(each) / 1000:.2f} ms" for each in (50, 95, 99)]
    ui.label(f"{histogram.count} iterations, {', '.join(percentiles)}, worst {histogram.worst_us / 1000:.2f} ms")
    ui.echart(
        {
            "animation": False,
            "grid": {"left": 45, "right": 10, "top": 10, "bottom": 25},
            "xAxis": {"type": "category", "data": [f"{longest_us / 1000:.2f}" for longest_us, _ in rows]},
            "yAxis": {"type": "value"},
            "series": [{"type": "bar", "data": [count for _, count in rows]}],
        }
    ).classes("w-full").style("height: 160px; flex: none").props('role=img aria-label="histogram"')
