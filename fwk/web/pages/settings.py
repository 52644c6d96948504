"""Page of the settings: a tree of all components, values with origin, type and meaning; changed live."""

import json
from collections.abc import Callable
from typing import Any

from nicegui import ui

from fwk.control.client import ControlError
from fwk.display.plan_overview import as_typed
from fwk.web.file_settings import differing, values_in_file
from fwk.web.layout import Frame, body

_TREE_S = 5.0
_FRESH_S = 0.5


def build(frame: Frame) -> None:
    """Makes the page."""
    link = frame.link
    chosen = {"name": frame.request.query_params.get("component", "")}
    with body():
        wanted = ui.input("filter by name, value, origin or meaning")
        wanted.props("dense outlined clearable debounce=300").classes("w-full").props("data-name=filter")
        with ui.row().classes("items-center gap-4"):
            different = ui.button("difference to the launch file", icon="difference", on_click=lambda: compare())
            different.props("dense outline no-caps").set_visibility(not link.recorded)
            save = ui.switch("keep changes for later runs on this machine")
            save.set_visibility(frame.may_steer)
        with ui.row().classes("w-full items-start no-wrap-md"):
            tree = ui.tree([], label_key="label", on_select=lambda event: choose(event.value or ""))
            tree.props('no-nodes-label="asking the run"')
            tree.classes("fwk-tree").props("data-name=tree")
            rows_area = ui.column().classes("fwk-settings")

    async def refresh_tree() -> None:
        nodes = tree_of(await link.settings(), wanted.value or "")
        if nodes != tree.props["nodes"]:
            tree.props["nodes"] = nodes
            tree.update()

    async def choose(name: str) -> None:
        chosen["name"] = name
        found = [
            row for row in await frame.do(link.settings(age_s=_FRESH_S)) or [] if matches(row, name, wanted.value or "")
        ]
        show(found, "no setting matches")

    def show(rows: list[dict[str, Any]], otherwise: str) -> None:
        rows_area.clear()
        with rows_area:
            for row in rows:
                _setting(frame, row, lambda: bool(save.value))
            if not rows:
                ui.label(otherwise)

    async def compare() -> None:
        async def found() -> list[dict[str, Any]]:
            values = await values_in_file((await link.about())["file"])
            return differing(await link.settings(age_s=_FRESH_S), values)

        different.props("loading")
        rows = await frame.do(found())
        different.props(remove="loading")
        if rows is not None:
            show(rows, "every setting is as in the launch file")

    wanted.on_value_change(lambda: choose(chosen["name"]))
    frame.every(_TREE_S, refresh_tree)
    if chosen["name"]:
        ui.timer(0.1, lambda: choose(chosen["name"]), once=True)


def tree_of(rows: list[dict[str, Any]], text: str) -> list[dict[str, Any]]:
    """Returns the nodes of the tree: namespaces with their components."""
    spaces: dict[str, list[str]] = {}
    for row in rows:
        if matches(row, "", text):
            names = spaces.setdefault(row["component"].partition("/")[0], [])
            if row["component"] not in names:
                names.append(row["component"])
    return [
        {"id": space, "label": space, "children": [{"id": name, "label": name.partition("/")[2]} for name in names]}
        for space, names in spaces.items()
    ]


def matches(row: dict[str, Any], name: str, text: str) -> bool:
    """Tells whether a setting belongs to a node of the tree and contains a text."""
    component = row["component"]
    words = (path_of(row), json.dumps(row["value"]), row["origin"], row["meaning"])
    return (not name or component == name or component.startswith(f"{name}/")) and (
        not text or any(text.lower() in word.lower() for word in words)
    )


def path_of(row: dict[str, Any]) -> str:
    """Returns the full name of a setting."""
    return f"{row['component']}.{row['setting']}"


def choices_of(row: dict[str, Any]) -> list[str]:
    """Returns the words of which a setting takes one; none if its value is typed, as a `str | int` is."""
    words: list[str] = row["type"].split(" | ")
    return words if row["value"] in words else []


def _setting(frame: Frame, row: dict[str, Any], saves: Callable[[], bool]) -> None:
    """Makes the field of a setting with its type, origin and meaning; keeps a change for later runs if `saves()`."""
    access = frame.access
    path = path_of(row)
    live = frame.may_steer and row["editable"]
    with ui.column().classes("fwk-setting w-full gap-0"):
        field: Any
        if row["type"] == "bool":
            field = ui.checkbox(path, value=bool(row["value"]))
        elif words := choices_of(row):
            field = ui.select(words, value=row["value"], label=path).props("dense outlined")
        else:
            field = ui.input(path, value=as_typed(row["value"])).props("dense outlined")
        field.classes("w-full").props["data-name"] = path
        field.set_enabled(live)
        details = ui.label(_details(row)).classes("text-caption opacity-70")
        mistake = ui.label("").classes("text-negative")
        mistake.props["data-name"] = f"mistake {path}"

    async def change() -> None:
        value = json.dumps(field.value) if row["type"] == "bool" else field.value
        try:
            answer = await access.set([f"{path}={value}"], saves())
        except ControlError as error:
            mistake.set_text(str(error))
            return
        mistake.set_text("")
        kept = ", kept for later runs" if saves() else ""
        details.set_text(f"{_details(row)}; changed here, since tick {answer['tick']}{kept}")
        ui.notify(f"{path} = {value} since tick {answer['tick']}", type="positive")

    if isinstance(field, ui.input):
        field.on("keydown.enter", change)
    else:
        field.on_value_change(change)


def _details(row: dict[str, Any]) -> str:
    in_file = f"in the launch file: {as_typed(row['in_file'])}" if "in_file" in row else ""
    fixed = "" if row["editable"] else "fixed for the run"
    parts = (in_file, row["type"], row["range"], row["origin"], fixed, row["meaning"])
    return ", ".join(filter(None, parts))
