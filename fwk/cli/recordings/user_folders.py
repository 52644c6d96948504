"""Folders of a recorded run with its own modules and message types."""

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from fwk.lcm.type_registry import put_first, source_folders, use_types_of
from fwk.lcm.typegen import TypeGenerationError
from fwk.model.plan import Plan
from fwk.recording.compare import plan_in

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
        LogError: the log cannot be read.
        TypeGenerationError: an .lcm file of `types` has mistakes.
    """
    use_types_of(types)
    plan = plan_in(log)
    for folder in plan.folders if plan else ():
        with suppress(TypeGenerationError, OSError):  # the project may have been changed, or removed
            use_types_of(Path(folder))
    if plan and _differ(plan, log.parent / _TYPES):
        use_types_of(log.parent)
    if types != Path():
        use_types_of(types)


def _differ(plan: Plan, copies: Path) -> bool:
    """Returns whether a type of the run was defined in another way than today."""
    names = {channel.type_name.partition(".")[0] for channel in plan.channels}
    recorded = [copies / f"{name}.lcm" for name in sorted(names) if (copies / f"{name}.lcm").is_file()]
    return any(_content(file) not in [_content(folder / file.name) for folder in source_folders()] for file in recorded)


def _content(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError:
        return b""
