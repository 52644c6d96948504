"""The plan as a JSON document, in recordings and run directories."""

import dataclasses
from functools import cache
from typing import TYPE_CHECKING, Any

from fwk.lcm.messages import current_name
from fwk.model.plan import Plan

if TYPE_CHECKING:
    from pydantic import TypeAdapter

VERSION = 2
"""Version of the document. Version 1 has no key `version`, and types of frames and transforms by their former names."""


def document_of(plan: Plan) -> dict[str, Any]:
    """Returns the document of a plan: plain data for JSON."""
    return {"version": VERSION, **dataclasses.asdict(plan)}


def plan_from(document: Any) -> Plan:
    """Returns the plan of a document of this or an earlier version.

    Raises:
        ValueError: the document is damaged, or of a newer version.
    """
    if not isinstance(document, dict):
        raise ValueError("the plan is not a JSON object")
    version = document.get("version", 1)
    if not isinstance(version, int) or not 1 <= version <= VERSION:
        raise ValueError(f"the plan has version {version!r}; this program reads versions 1 to {VERSION}")
    content = {key: value for key, value in document.items() if key != "version"}
    plan = _adapter().validate_python(content)
    return plan if version == VERSION else _with_current_names(plan)


@cache
def _adapter() -> "TypeAdapter[Plan]":
    from pydantic import TypeAdapter

    return TypeAdapter(Plan)


def _with_current_names(plan: Plan) -> Plan:
    channels = tuple(dataclasses.replace(each, type_name=current_name(each.type_name)) for each in plan.channels)
    outside = {name: current_name(kind) for name, kind in plan.outside.items()}
    return dataclasses.replace(plan, channels=channels, outside=outside)
