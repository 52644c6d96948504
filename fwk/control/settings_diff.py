"""What the launch files say otherwise than a run has it: for taking over edited files without a new start."""

from collections.abc import Sequence
from typing import Any

from fwk.control.yaml_edit import flow
from fwk.model.plan import Plan
from fwk.plan.files.overrides import PLACE


def differences(rows: Sequence[dict[str, Any]], plan: Plan) -> tuple[list[str], list[str]]:
    """`NAME.SETTING=VALUE` for each setting of a run that the freshly loaded plan has otherwise.

    First those that can be changed while the run goes on, then the others. What was typed with `--set` when the run
    began stays.
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
