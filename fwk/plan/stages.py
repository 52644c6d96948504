"""Stages of the main loop, and those in which a component iterates."""

import re
from collections.abc import Sequence

from fwk.component.component import DEFAULT_STAGES
from fwk.component.declaration import Declaration
from fwk.model.errors import Problems, hint
from fwk.model.ports import STAGES_MAX
from fwk.plan.files.launch_file import Files
from fwk.plan.files.templates import Asked

_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)


def stages_of(files: Files, problems: Problems) -> tuple[str, ...]:
    """Returns the stages that the files name, or the default ones."""
    layer = next((layer for layer in reversed(files.layers) if layer.content.stages is not None), None)
    if layer is None:
        return DEFAULT_STAGES
    names, node = layer.content.stages or [], layer.node.at("stages")
    if not 1 <= len(names) <= STAGES_MAX:
        problems.add(node.place, "", f"there are {len(names)} stages; a main loop has 1 to {STAGES_MAX}")
    for index, name in enumerate(names):
        if not _NAME.fullmatch(name):
            problems.add(node.at(index).place, "", f"'{name}' is not a valid stage name; use letters, digits and '_'")
        elif name in names[:index]:
            problems.add(node.at(index).place, "", f"stage '{name}' occurs twice; keep one")
    return tuple(names)


def stages_in(asked: Asked, declared: Declaration, stages: Sequence[str], problems: Problems) -> tuple[int, ...]:
    """Returns the indices of a component's stages, in the order of the plan; none for a continuous component."""
    if declared.rate_hz is not None:
        if asked.entry.stage is not None:
            text = "it is continuous and takes part in no stage; leave 'stage' out"
            problems.add(asked.node.at("stage").place, asked.name, text)
        return ()
    if asked.entry.rate_hz is not None:
        text = "it takes part in stages; leave 'rate_hz' out, or give its class a rate_hz instead of a stage"
        problems.add(asked.node.at("rate_hz").place, asked.name, text)
    wanted = asked.entry.stage if asked.entry.stage is not None else declared.stages
    place = asked.node.at("stage").place
    for name in wanted:
        if name not in stages:
            problems.add(place, asked.name, f"no stage '{name}'; {hint(name, stages)}")
    if not wanted:
        problems.add(place, asked.name, "it takes part in no stage; name at least one")
    return tuple(index for index, name in enumerate(stages) if name in wanted)
