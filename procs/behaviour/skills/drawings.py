"""Draws the state machines of the skills: python -m procs.behaviour.skills.drawings docs/soccer.md.

The drawings are Mermaid, which GitHub and editors show; they stand in a page between the two marks.
"""

import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from procs.behaviour.skills.book import SKILLS
from procs.behaviour.skills.skill import Status
from procs.behaviour.skills.states import Guard, State, StateMachine

BEGIN, END = "<!-- skills: made by procs.behaviour.skills.drawings -->", "<!-- end of skills -->"
_INDENT = "    "


def drawing(skill: type[StateMachine]) -> str:
    """Returns the state diagram of a skill."""
    return "\n".join(["stateDiagram-v2", *_level(skill.STATES, "", not skill.lasting)])


def page() -> str:
    """Returns the drawings of all skills as Markdown; skills with the same states share one."""
    names: dict[str, list[str]] = {}
    for name, skill in SKILLS.items():
        names.setdefault(drawing(skill), []).append(name)
    drawn = [f"**{', '.join(sharing)}**\n\n```mermaid\n{lines}\n```" for lines, sharing in names.items()]
    return "\n\n".join([BEGIN, *drawn, END])


def redraw(file: Path) -> bool:
    """Writes the drawings between the marks of a page; returns whether the page has changed.

    Raises:
        ValueError: the page lacks a mark, or is not text.
        OSError: the page cannot be read or written.
    """
    try:
        text = file.read_text()
    except UnicodeDecodeError as error:
        raise ValueError(f"{file} is not a page: {error}; it should be UTF-8 text") from error
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"{file} has no line '{BEGIN}' with a line '{END}' after it")
    drawn = before + page() + after
    if drawn != text:
        file.write_text(drawn)
    return drawn != text


def _level(states: Sequence[State], inside: str, ends: bool) -> Iterator[str]:
    """Draws the states of a level; `inside` is the path of the state that holds them."""
    indent = _INDENT * (inside.count("/") + 1 + bool(inside))
    prefix = f"{inside}/" if inside else ""
    for state in states:
        own = _name(prefix + state.name)
        if state.inside:
            yield f'{indent}state "{state.name}" as {own} {{'
            yield from _level(state.inside, prefix + state.name, ends)
            yield from _choice(state, prefix + state.name, indent + _INDENT)
            yield f"{indent}}}"
        else:
            yield f'{indent}state "{state.name}" as {own}'
    if not inside:
        yield f"{indent}[*] --> {_name(states[0].name)}"
    for state in states:
        for way in state.exits:
            yield f"{indent}{_name(prefix + state.name)} --> {_name(prefix + way.to)}: {_words(way.when)}"
        if state.status is Status.FAILED or (state.status is Status.FINAL and ends):
            yield f"{indent}{_name(prefix + state.name)} --> [*]: {state.status.name.lower()}"


def _choice(state: State, path: str, indent: str) -> Iterator[str]:
    """Draws how the state inside is chosen, or which one is the first."""
    if not state.choice:
        yield f"{indent}[*] --> {_name(f'{path}/{state.inside[0].name}')}"
        return
    point = _name(f"{path}/choice")
    yield f"{indent}state {point} <<choice>>"
    yield f"{indent}[*] --> {point}"
    for rank, way in enumerate(state.choice, start=1):
        yield f"{indent}{point} --> {_name(f'{path}/{way.to}')}: {rank}. {_words(way.when)}"


def _name(path: str) -> str:
    """Returns a name of letters, digits and underscores: Mermaid takes no others, such as hyphens."""
    return re.sub(r"\W", "_", path.replace("/", "__"))


def _words(guard: Guard) -> str:
    """Returns a condition in words: the name of its method."""
    return guard.__name__.strip("_").replace("_", " ")


def _main(arguments: Sequence[str]) -> int:
    if len(arguments) != 1:
        print("usage: python -m procs.behaviour.skills.drawings PAGE", file=sys.stderr)
        return 2
    try:
        changed = redraw(Path(arguments[0]))
    except OSError as error:
        print(f"{arguments[0]}: {error.strerror}; name a page of text, such as docs/soccer.md", file=sys.stderr)
        return 2
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    print(f"{arguments[0]}: {'drawn anew' if changed else 'up to date'}")
    return 0


if __name__ == "__main__":
    sys.exit(_main(sys.argv[1:]))
