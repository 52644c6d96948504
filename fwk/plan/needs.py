"""The order in which components start: who needs whom, and the ring that must not be in it."""

from collections.abc import Mapping, Sequence


def ring(needs: Mapping[str, Sequence[str]]) -> list[str]:
    """A ring of components that wait for each other, first and last the same; empty if there is none."""
    done: set[str] = set()
    for start in needs:
        found = _from(start, needs, done, [])
        if found:
            return found
    return []


def _from(name: str, needs: Mapping[str, Sequence[str]], done: set[str], way: list[str]) -> list[str]:
    if name in way:
        return [*way[way.index(name) :], name]
    if name not in done:
        for other in needs.get(name, ()):
            found = _from(other, needs, done, [*way, name])
            if found:
                return found
        done.add(name)
    return []
