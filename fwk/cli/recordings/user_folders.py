"""Folders of a recorded run with its own modules and message types."""

import json
from collections.abc import Sequence, Set
from contextlib import suppress
from pathlib import Path
from typing import Any

from fwk.lcm.event_log import LogReader
from fwk.lcm.messages import fingerprint
from fwk.lcm.type_registry import put_first, source_folders, use_types_of
from fwk.lcm.typegen import TypeGenerationError
from fwk.recording.versions import BROKEN, PLAN
from lcmtypes import core, core_v1

_TYPES = "lcmtypes"


def use_folders(folders: Sequence[str]) -> None:
    """Makes the modules and message types of these folders available, before installed ones of the same name."""
    for folder in folders:
        use_types_of(Path(folder))
    put_first([str(Path(folder).resolve()) for folder in folders])


def use_types_of_run(log: Path, types: Path) -> None:
    """Makes message types of a log available: those of `types`, and of a recording those of its run.

    The types of the run come from its folders, and from the copies beside its log if a type was another one then. Types
    that the user has named, as another folder than the present one, take precedence.

    Raises:
        LogError: the file cannot be read, or is not a log.
        TypeGenerationError: an .lcm file of `types` has mistakes.
    """
    use_types_of(types)
    plan = plan_document(log)
    for folder in plan.get("folders", ()):
        with suppress(TypeGenerationError, OSError):  # the project may have been changed, or removed
            use_types_of(Path(folder))
    if _differ({str(channel["type_name"]) for channel in plan.get("channels", ())}, log.parent / _TYPES):
        use_types_of(log.parent)
    if types != Path():
        use_types_of(types)


def plan_document(log: Path) -> dict[str, Any]:
    """Returns the plan that a recording begins with, as plain data, which takes far less time than a `Plan`.

    Raises:
        LogError: the file cannot be read, or is not a log.
    """
    reader = LogReader(log)
    first = next(iter(reader), None)
    reader.check_any()
    if first is None or first.channel != PLAN:
        return {}
    kind = core_v1.plan_t if first.data[:8] == fingerprint(core_v1.plan_t) else core.plan_t
    try:
        return dict(json.loads(kind.decode(first.data).json))
    except BROKEN:
        return {}


def _differ(types: Set[str], copies: Path) -> bool:
    """Returns whether a type of the run was defined in another way than today."""
    names = {name.partition(".")[0] for name in types}
    recorded = [copies / f"{name}.lcm" for name in sorted(names) if (copies / f"{name}.lcm").is_file()]
    return any(_content(file) not in [_content(folder / file.name) for folder in source_folders()] for file in recorded)


def _content(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError:
        return b""
