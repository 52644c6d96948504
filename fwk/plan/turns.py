"""Ticks in which a component iterates: `every` and `offset`, beside its `use`, among its settings or in its class."""

from fwk.component.declaration import EVERY_MAX, Declaration
from fwk.model.errors import Problems
from fwk.plan.files.overrides import PLACE
from fwk.plan.files.schema import EVERY, OFFSET
from fwk.plan.files.source import Node
from fwk.plan.files.templates import Asked

_FORMER = "every_ticks"
"""A setting of former cameras, which counted their ticks themselves."""
_OFFSET_DIGITS = 6
Turns = dict[str, Node]
"""Nodes of `every` and `offset` under these names; a name is missing if the files do not state it."""


def split_turns(asked: Asked, declared: Declaration, problems: Problems) -> tuple[list[Node], Turns]:
    """Returns the layers of settings without `every` and `offset`, and what the files say of both; later layers win.

    So a file, or `--set`, changes the turns of a component that a template of another file names. A class with a
    setting of its own under such a name keeps it.
    """
    turns = {name: node for name in (EVERY, OFFSET) if (node := asked.node.child(name)) and node.value is not None}
    taken = {EVERY, OFFSET, _FORMER} - set(declared.config.model_fields)
    layers = []
    for layer in asked.settings():
        for name in (EVERY, OFFSET):
            if name in taken and (node := layer.child(name)):
                turns[name] = node
        if _FORMER in taken and (node := layer.child(_FORMER)) and _fits(asked, node, problems):
            turns[EVERY] = node
        kept = {key: node for key, node in layer.value.items() if key not in taken}
        layers.append(Node(kept, layer.place))
    return layers, turns


def turns_of(asked: Asked, declared: Declaration, turns: Turns, problems: Problems) -> tuple[int, int]:
    """Returns `every` and `offset` of a component: those of the files, or else of its class."""
    every = _every(asked, declared, turns, problems)
    if every > 1 and declared.rate_hz is not None:
        text = "it is continuous and takes part in no tick; leave 'every' out"
        problems.add(_place(asked, turns, EVERY), asked.name, text)
    if every > 1 and "time_source" in declared.aspects.values():
        text = "a time source iterates in each tick; leave 'every' out"
        problems.add(_place(asked, turns, EVERY), asked.name, text)
    return every, _offset(asked, declared, turns, every, problems)


def _place(asked: Asked, turns: Turns, name: str) -> str:
    return turns[name].place if name in turns else asked.node.place


def _fits(asked: Asked, node: Node, problems: Problems) -> bool:
    """Notes a former setting; one in a file that contradicts `every` is a mistake, one of the command line wins."""
    if not _is_whole(_FORMER, asked, node, problems):
        return False
    if node.place != PLACE and asked.entry.every not in (None, node.value):
        text = f"{_FORMER} is {node.value}, but every is {asked.entry.every} at {asked.node.at(EVERY).place}"
        problems.add(node.place, asked.name, f"{text}; leave {_FORMER} out")
        return False
    problems.note(
        node.place, asked.name, f"the setting '{_FORMER}' is called '{EVERY}' now; say '{EVERY}: {node.value}'"
    )
    return True


def _is_whole(name: str, asked: Asked, node: Node, problems: Problems) -> bool:
    """Returns whether a node is a number of ticks; any other value is a mistake."""
    value = node.value
    if isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= EVERY_MAX:
        return True
    text = f"{name} is {node.plain()!r}; it should be a whole number from 1 to {EVERY_MAX}"
    problems.add(node.place, asked.name, text)
    return False


def _every(asked: Asked, declared: Declaration, turns: Turns, problems: Problems) -> int:
    node = turns.get(EVERY)
    if node is None or node.value is None:
        return declared.every
    return int(node.value) if _is_whole(EVERY, asked, node, problems) else declared.every


def _offset(asked: Asked, declared: Declaration, turns: Turns, every: int, problems: Problems) -> int:
    node = turns.get(OFFSET)
    if node is None or node.value is None:
        return declared.offset
    text = str(node.plain())
    if not text.isdecimal() or not text.isascii() or len(text) > _OFFSET_DIGITS:
        right = f"it should be a whole number from 0 on, of at most {_OFFSET_DIGITS} digits, such as 1 or '{{number}}'"
        problems.add(node.place, asked.name, f"offset is '{text}'; {right}")
        return 0
    if every == 1 and declared.rate_hz is not None:
        problems.add(node.place, asked.name, "it is continuous and takes part in no tick; leave 'offset' out")
    elif every == 1 and int(text) and EVERY not in turns:
        problems.note(node.place, asked.name, "'offset' changes nothing, because it iterates in each tick; add 'every'")
    return int(text)
