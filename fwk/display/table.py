"""Plain text tables that fit the terminal: names are never cut; columns of less interest are left out instead."""

import os
from collections.abc import Iterator, Sequence
from typing import NamedTuple

_GAP = "  "
_WRAPPED_MIN = 24  # narrower columns of prose are left out
_RESET = "\x1b[0m"
STYLES = {"green": "32", "yellow": "33", "red": "31;1", "cyan": "36", "dim": "2", "bold": "1"}


class Column(NamedTuple):
    """Column of a table."""

    title: str
    right: bool = False
    rank: int = 0
    """0: always shown; of the others, the highest are left out first."""
    prose: bool = False
    """Text that may continue on the next line; only for the last column."""


class Table:
    """Rows of text under titled columns."""

    def __init__(self, *columns: Column | str) -> None:
        self._columns = [Column(each) if isinstance(each, str) else each for each in columns]
        self._rows: list[tuple[tuple[str, ...], str]] = []

    def add(self, *cells: object, style: str = "") -> None:
        """Adds a row of one cell for each column; `style` is one of `STYLES`."""
        self._rows.append((tuple(_clean(str(cell)) for cell in cells), style))

    def lines(self, width: int | None, colour: bool = False) -> Iterator[str]:
        """Yields the lines for a terminal of `width` columns; None: of any width."""
        shown = self._fitting(width)
        widths = {index: self._width(index) for index in shown}
        last = shown[-1]
        if self._columns[last].prose and width is not None:
            used = sum(widths[index] + len(_GAP) for index in shown[:-1])
            widths[last] = max(_WRAPPED_MIN, min(widths[last], width - used))
        if any(column.title for column in self._columns):
            titles = tuple(column.title for column in self._columns)
            yield from self._row(titles, shown, widths, "dim" if colour else "")
        for cells, style in self._rows:
            yield from self._row(cells, shown, widths, style if colour else "")
        full = self._fitting(None)
        missing = [self._columns[index].title for index in full if index not in shown]
        if missing:
            note = f"(not shown, for want of room: {', '.join(missing)})"
            yield _styled(note, "dim" if colour else "")

    def _fitting(self, width: int | None) -> list[int]:
        """Returns the indices of the columns that fit, in their order."""
        shown = [index for index, column in enumerate(self._columns) if not column.rank or self._filled(index)]
        while width is not None and self._total(shown) > width:
            optional = [index for index in shown if self._columns[index].rank]
            if not optional:
                break
            shown.remove(max(optional, key=lambda index: self._columns[index].rank))
        return shown

    def _total(self, shown: Sequence[int]) -> int:
        widths = [_WRAPPED_MIN if self._columns[index].prose else self._width(index) for index in shown]
        return sum(widths) + len(_GAP) * (len(shown) - 1)

    def _filled(self, index: int) -> bool:
        return not self._rows or any(cells[index] for cells, _ in self._rows)

    def _width(self, index: int) -> int:
        return max([cells(self._columns[index].title), *(cells(row[index]) for row, _ in self._rows)])

    def _row(self, row: Sequence[str], shown: Sequence[int], widths: dict[int, int], style: str) -> Iterator[str]:
        parts = [_padded(row[index], widths[index], self._columns[index].right) for index in shown[:-1]]
        last = shown[-1]
        if not self._columns[last].prose:
            parts.append(_padded(row[last], widths[last], self._columns[last].right))
            yield _styled(_GAP.join(parts).rstrip(), style)
            return
        first, *others = wrapped(row[last], widths[last]) or [""]
        yield _styled(_GAP.join([*parts, first]).rstrip(), style)
        indent = " " * sum(widths[index] + len(_GAP) for index in shown[:-1])
        for line in others:
            yield _styled(indent + line, style)


def cells(text: str) -> int:
    """Returns how many columns of a terminal a text takes."""
    if text.isascii():
        return len(text)
    from unicodedata import east_asian_width  # most commands print ASCII alone

    return sum(2 if east_asian_width(each) in "FW" else 1 for each in text)


def wrapped(text: str, width: int) -> list[str]:
    """Breaks a text between words, and longer words anywhere, into lines of at most `width` columns."""
    lines: list[str] = []
    line = ""
    for word in text.split(" "):
        if line and cells(line) + 1 + cells(word) > width:
            lines.append(line)
            line = ""
        line = f"{line} {word}" if line else word
        if cells(line) > width:
            *full, line = _broken(line, max(2, width))
            lines += full
    return [*lines, line] if line else lines


def _broken(word: str, width: int) -> list[str]:
    """Breaks a word anywhere into parts of at most `width` columns, which is at least 2."""
    parts, begin, used = [], 0, 0
    for place, character in enumerate(word):
        taken = cells(character)
        if used + taken > width:
            parts.append(word[begin:place])
            begin, used = place, 0
        used += taken
    return [*parts, word[begin:]]


def terminal_width(descriptor: int = 1) -> int | None:
    """Returns the width of the terminal, or None where output goes to a file or pipe."""
    try:
        if not os.isatty(descriptor):
            return None
        return int(os.environ.get("COLUMNS", 0)) or os.get_terminal_size(descriptor).columns or 80
    except (OSError, ValueError):
        return None


def has_colour(descriptor: int = 1) -> bool:
    """Tells whether output may have colours: on a terminal, unless NO_COLOR is set."""
    try:
        return os.isatty(descriptor) and not os.environ.get("NO_COLOR")
    except OSError:
        return False


def _padded(text: str, width: int, right: bool) -> str:
    space = " " * (width - cells(text))
    return space + text if right else text + space


def _styled(text: str, style: str) -> str:
    return f"\x1b[{STYLES[style]}m{text}{_RESET}" if style else text


def _clean(text: str) -> str:
    """Replaces characters that would move the cursor or break the line."""
    return text if text.isprintable() else "".join(each if each.isprintable() else "�" for each in text)
