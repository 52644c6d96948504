"""Compares launch files with the settings of a run, to take over edited files without a restart."""

from collections.abc import Sequence
from typing import Any

from fwk.control.yaml_edit import flow
from fwk.model.plan import Plan
from fwk.plan.files.overrides import PLACE
from fwk.plan.files.schema import EVERY, OFFSET


def differences(
    rows: Sequence[dict[str, Any]], plan: Plan, components: Sequence[dict[str, Any]] = ()
) -> tuple[list[str], list[str]]:
    """Returns `NAME.SETTING=VALUE` for each setting of a run that differs in the freshly loaded plan.

    First those that can be changed during the run, then the others: fixed settings, and mappings that lack a key in the
    files, because a key stays until the run ends; and `every` and `offset` of `components`, as the run tells them.
    Values given with `--set` at the start of the run stay.
    """
    planned = {component.name: component for component in plan.components}
    values = {name: component.config for name, component in planned.items()}
    now: list[str] = []
    later: list[str] = []
    for row in rows:
        name, setting = row["component"], row["setting"]
        if name not in values or row["origin"] == PLACE:
            continue
        found, value = _found(values[name], setting)
        if value != row["value"] and found:
            (now if row["editable"] and found == setting else later).append(f"{name}.{found}={flow(value)}")
    for was in components:
        turns = {key: getattr(planned[was["name"]], key) for key in (EVERY, OFFSET) if was["name"] in planned}
        later += [f"{was['name']}.{key}={value}" for key, value in turns.items() if value != was[key]]
    return now, list(dict.fromkeys(later))


def _found(config: dict[str, Any], setting: str) -> tuple[str, Any]:
    """Returns the dotted name and the value of a setting, or of the mapping that lacks it; the name may be empty."""
    found: list[str] = []
    value: Any = config
    for key in setting.split("."):
        if not isinstance(value, dict) or key not in value:
            break
        found.append(key)
        value = value[key]
    return ".".join(found), value
