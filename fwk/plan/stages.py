"""Stages of the main loop, and the stages and ticks in which a component iterates."""

import re
from collections.abc import Sequence

from fwk.component.component import DEFAULT_STAGES
from fwk.component.declaration import EVERY_MAX, Declaration
from fwk.model.errors import Problems, hint
from fwk.model.ports import STAGES_MAX
from fwk.plan.files.launch_file import Files
from fwk.plan.files.overrides import PLACE
from fwk.plan.files.source import Node
from fwk.plan.files.templates import Asked

_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_OFFSET_DIGITS = 6
_FORMER_EVERY = "every_ticks"


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


def without_former_every(asked: Asked, declared: Declaration, problems: Problems) -> tuple[list[Node], int | None]:
    """Returns the settings without `every_ticks`, a setting of former cameras that is now `every`, and its value.

    A component that has a setting of that name keeps it. One in a file that contradicts `every` is a mistake; one of
    the command line wins.
    """
    layers, every = asked.settings(), None
    if _FORMER_EVERY in declared.config.model_fields:
        return layers, None
    for index, layer in enumerate(layers):
        node = layer.child(_FORMER_EVERY)
        if node is None:
            continue
        layers[index] = Node({key: each for key, each in layer.value.items() if key != _FORMER_EVERY}, layer.place)
        if isinstance(node.value, int) and not isinstance(node.value, bool) and 1 <= node.value <= EVERY_MAX:
            every = node.value
            if node.place != PLACE and asked.entry.every not in (None, every):
                there = asked.node.at("every").place
                text = f"{_FORMER_EVERY} is {every}, but every is {asked.entry.every} at {there}"
                problems.add(node.place, asked.name, f"{text}; leave {_FORMER_EVERY} out")
                continue
            text = (
                f"the setting '{_FORMER_EVERY}' has become a key of the component; say 'every: {every}' beside 'use:'"
            )
            problems.note(node.place, asked.name, text)
        else:
            text = f"{_FORMER_EVERY} is {node.value!r}; it should be a whole number from 1 to {EVERY_MAX}"
            problems.add(node.place, asked.name, text)
    return layers, every


def turns_of(asked: Asked, declared: Declaration, former: int | None, problems: Problems) -> tuple[int, int]:
    """Returns `every` and `offset` of a component: those of the launch file, or else of its class.

    `former` is the value of the former setting `every_ticks`.
    """
    every = former or (declared.every if asked.entry.every is None else asked.entry.every)
    if every > 1 and declared.rate_hz is not None:
        text = "it is continuous and takes part in no tick; leave 'every' out"
        problems.add(asked.node.at("every").place, asked.name, text)
    if every > 1 and "time_source" in declared.aspects.values():
        problems.add(asked.node.at("every").place, asked.name, "a time source iterates in each tick; leave 'every' out")
    node = asked.node.child("offset")
    text = str(declared.offset if node is None or node.value is None else node.value)
    if not text.isdecimal() or not text.isascii() or len(text) > _OFFSET_DIGITS:
        place = node.place if node else asked.node.place
        right = f"it should be a whole number from 0 on, of at most {_OFFSET_DIGITS} digits, such as 1 or '{{number}}'"
        problems.add(place, asked.name, f"offset is '{text}'; {right}")
        return every, 0
    if node is not None and node.value is not None and every == 1:
        _refuse_idle_offset(asked, declared, node, int(text), problems)
    return every, int(text)


def _refuse_idle_offset(asked: Asked, declared: Declaration, node: Node, offset: int, problems: Problems) -> None:
    """Notes an offset of the launch file that changes nothing; that of a continuous component is a mistake."""
    if declared.rate_hz is not None:
        text = "it is continuous and takes part in no tick; leave 'offset' out"
        problems.add(node.place, asked.name, text)
    elif offset and asked.entry.every is None:
        problems.note(node.place, asked.name, "'offset' changes nothing, because it iterates in each tick; add 'every'")
