"""Compares launch files with the settings of a run, to take over edited files without a restart."""

from collections.abc import Sequence
from typing import Any

from fwk.control.yaml_edit import flow
from fwk.model.plan import Plan
from fwk.plan.files.overrides import PLACE


def differences(rows: Sequence[dict[str, Any]], plan: Plan) -> tuple[list[str], list[str]]:
    """Returns `NAME.SETTING=VALUE` for each setting of a run that differs in the freshly loaded plan.

    First those that can be changed during the run, then the others. Values given with `--set` at the start of the run
    stay.
    """
    values = {component.name: component.config for component in plan.components}
    now: list[str] = []
    later: list[str] = []
    for row in rows:
        name, setting = row["component"], row["setting"]
        if name not in values or row["origin"] == PLACE:
            continue
        value: Any = values[name]
        for key in setting.split("."):
            value = value.get(key) if isinstance(value, dict) else None
        if value is not None and value != row["value"]:
            (now if row["editable"] else later).append(f"{name}.{setting}={flow(value)}")
    return now, later
