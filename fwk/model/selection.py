"""Selection of components by patterns, in settings, hosts, `--only` and `--without`."""

from collections.abc import Iterable, Mapping, Sequence
from fnmatch import fnmatchcase

from fwk.model.errors import Problems, hint


def matches(name: str, pattern: str) -> bool:
    """Returns whether a pattern selects a component: by its name with `*` for any part, or by its namespace."""
    return fnmatchcase(name, pattern) or name.startswith(f"{pattern}/")


def nearest(pattern: str, names: Sequence[str]) -> str:
    """Returns a hint for a pattern that selects no component."""
    namespaces = [name.rpartition("/")[0] for name in names if "/" in name]
    return hint(pattern, dict.fromkeys(names if "/" in pattern else [*namespaces, *names]))


def dot_for_slash(pattern: str, keys: Iterable[str], names: Sequence[str]) -> str:
    """Returns what is wrong with `pattern.key` where a component is `pattern/key`; empty if there is none."""
    below = (f"{pattern}/{key}" for key in keys)
    meant = next((each for each in below if any(matches(name, each) for name in names)), "")
    return f"'{pattern}' is not a component; did you mean '{meant}'?" if meant else ""


def chosen(names: Sequence[str], only: Sequence[str], without: Sequence[str], problems: Problems) -> list[str]:
    """Returns the names that `--only` and `--without` select."""
    idle = False
    for option, patterns in (("--only", only), ("--without", without)):
        for pattern in patterns:
            if not any(matches(name, pattern) for name in names):
                idle = True
                problems.add(option, "", f"'{pattern}' matches no component; {nearest(pattern, names)}")
    kept = [
        name
        for name in names
        if (not only or any(matches(name, pattern) for pattern in only))
        and not any(matches(name, pattern) for pattern in without)
    ]
    if names and not kept and not idle:
        problems.add("--without" if without else "--only", "", "no component is left; leave a pattern out")
    return kept


def groups_of(
    names: Sequence[str], groups: Mapping[str, Sequence[str]], places: Mapping[str, str], problems: Problems
) -> dict[str, str]:
    """Returns the group of each component in a group; `places` are the places of the groups in the files."""
    found: dict[str, str] = {}
    for group, patterns in groups.items():
        if group in names:
            text = f"'{group}' is a component; give the process of several another name"
            problems.add(places[group], "", text)
        for pattern in patterns:
            members = [name for name in names if matches(name, pattern)]
            if not members:
                problems.add(places[group], "", f"'{pattern}' matches no component; {nearest(pattern, names)}")
            for name in members:
                if found.setdefault(name, group) != group:
                    problems.add(
                        places[group], name, f"it is in two processes, '{found[name]}' and '{group}'; keep one"
                    )
    return found
