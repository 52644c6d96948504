"""Explains words that are no command of `fwk`, with the commands that were probably meant."""

from difflib import get_close_matches

from fwk.cli.index import read, subcommands
from fwk.model.errors import there

_ELSEWHERE = {
    "echo": ("fwk bb watch",),
    "topic": ("fwk bb list",),
    "launch": ("fwk-launch",),
    "run": ("fwk-launch", "fwk runs"),
}
"""Words of other programs for robots, to the commands that do the same here."""


def mistake(words: list[str]) -> str:
    """Returns what is wrong with the first words of a command line, and what would be right; empty for a command."""
    commands = read()
    path: tuple[str, ...] = ("fwk",)
    for word in words:
        known = subcommands(commands, path)
        if not known or word.startswith("-"):
            return ""
        if word not in known:
            below = [" ".join(each.words) for each in commands if len(each.words) > 2 and each.words[-1] == word]
            meant = [*_ELSEWHERE.get(word, ()), *below] if len(path) == 1 else []
            near = [" ".join((*path, each)) for each in get_close_matches(word, known, 1)]
            return f"no command '{' '.join((*path, word))}'; {_right(meant or near, path, known)}"
        path = (*path, word)
    return ""


def _right(meant: list[str], path: tuple[str, ...], known: dict[str, str]) -> str:
    if meant:
        *others, last = [f"'{each}'" for each in meant]
        return f"did you mean {', '.join(others)} or {last}?" if others else f"did you mean {last}?"
    return "see 'fwk --help'" if len(path) == 1 else f"{there(known)} {', '.join(known)}"
