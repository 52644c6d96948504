"""Mistakes in launch files, collected so that one check reports them all."""

from collections.abc import Iterable, Mapping, Sequence, Sized
from dataclasses import dataclass
from difflib import get_close_matches

_LISTED = 12


@dataclass(frozen=True)
class Problem:
    """A mistake: `launch/robot.yaml:41: cyan1/omni_ball: no setting 'least_ft'; did you mean 'least_fit'?`."""

    place: str
    """File and line, or the command-line option."""
    who: str
    """Name of the component; empty if the mistake concerns no single component."""
    text: str
    """The mistake, and what would be right."""

    def __str__(self) -> str:
        return ": ".join(part for part in (self.place, self.who, self.text) if part)


class PlanError(Exception):
    """A launch file has mistakes; the text has a line for each, in the order of files and lines."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(map(str, self.problems)))


class Problems:
    """Collects mistakes.

    A mistake in a template occurs in every robot that uses it; it is reported once, with their number. So is a note.
    """

    def __init__(self) -> None:
        self._found: dict[tuple[str, str], list[Problem]] = {}
        self._notes: dict[tuple[str, str], list[Problem]] = {}

    def __bool__(self) -> bool:
        return bool(self._found)

    def add(self, place: str, who: str, text: str) -> None:
        """Adds a mistake."""
        _add(self._found, Problem(place, who, text))

    def note(self, place: str, who: str, text: str) -> None:
        """Adds a note: an entry of an earlier version, which is understood but has a better form."""
        _add(self._notes, Problem(place, who, text))

    @property
    def notes(self) -> list[Problem]:
        """All notes, in the order of files and lines."""
        return sorted(map(_together, self._notes.values()), key=_position)

    def stop_if_any(self) -> None:
        """Ends the check if there is a mistake.

        Raises:
            PlanError: all mistakes so far.
        """
        if self._found:
            raise PlanError(sorted(map(_together, self._found.values()), key=_position))


def _add(found: dict[tuple[str, str], list[Problem]], problem: Problem) -> None:
    namespace = problem.who.rpartition("/")[0]
    alike = problem.text.replace(f"{namespace}/", "{namespace}/") if namespace else problem.text
    found.setdefault((problem.place, alike), []).append(problem)


def _together(alike: list[Problem]) -> Problem:
    first = alike[0]
    more = len({problem.who for problem in alike} - {first.who})
    return Problem(first.place, f"{first.who} (and {more} more)", first.text) if more else first


def _position(problem: Problem) -> tuple[bool, str, int]:
    file, _, line = problem.place.rpartition(":")
    return (False, file, int(line)) if line.isdecimal() and len(line) < 10 else (True, problem.place, 0)


def hint(word: str, known: Iterable[str] | Mapping[str, object], otherwise: str = "") -> str:
    """Returns a hint for a wrong word: the nearest known word, otherwise `otherwise`, otherwise all known words."""
    names = sorted(known)
    # a common namespace or package alone would make names alike
    own = [name for name in names if get_close_matches(_last_part(word), [_last_part(name)], 1)]
    same = [name for name in own if _last_part(name) == word]  # the whole word lacks its namespace
    near = same or get_close_matches(word, own, 1)
    if near:
        return f"did you mean '{near[0]}'?"
    more = ", ..." if len(names) > _LISTED else ""
    return otherwise or (f"{there(names)} {', '.join(names[:_LISTED])}{more}" if names else "there is none")


def some(things: Sequence[object], most: int) -> str:
    """Returns the first of some things, and the number of those left out: `a, b and 3 more`."""
    more = f" and {len(things) - most} more" if len(things) > most else ""
    return ", ".join(map(str, things[:most])) + more


def there(things: Sized) -> str:
    """Returns how a list of these things begins."""
    return "there are" if len(things) > 1 else "there is"


def _last_part(name: str) -> str:
    return name.replace(".", "/").rpartition("/")[2]
