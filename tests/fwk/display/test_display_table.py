"""Tables: names are never cut, columns of less interest are left out."""

import pytest

from fwk.display.table import Column, Table, cells, wrapped

NAME = "a_rather_long_namespace/with_a_component_of_a_long_name"


def table() -> Table:
    made = Table("component", "state", Column("pid", right=True, rank=2), Column("ms", right=True, rank=1))
    made.add(NAME, "running", 4711, "1.50")
    made.add("b/c", "failed", 12, "10.00", style="red")
    return made


def test_a_wide_terminal_shows_all_columns() -> None:
    head, first, second = table().lines(None)
    assert head.split() == ["component", "state", "pid", "ms"]
    assert first == f"{NAME}  running  4711   1.50"
    assert second.endswith("    12  10.00")


@pytest.mark.parametrize(("width", "missing"), [(76, "pid"), (70, "ms, pid"), (20, "ms, pid")])
def test_columns_are_dropped_before_names_are_cut(width: int, missing: str) -> None:
    *rows, note = table().lines(width)
    assert f"{NAME}  running" in rows[1]
    assert sorted(note.removeprefix("(not shown, for want of room: ").rstrip(")").split(", ")) == missing.split(", ")


def test_prose_continues_on_the_next_line() -> None:
    made = Table("setting", Column("meaning", rank=1, prose=True))
    made.add("gain", "a b c d e f g h i j k l m n o p q r s t u v w x y z")
    head, first, second = made.lines(40)
    assert head == "setting  meaning"
    assert (first, second) == ("gain     a b c d e f g h i j k l m n o p", "         q r s t u v w x y z")


def test_an_empty_optional_column_is_left_out_silently() -> None:
    made = Table("name", Column("lost", rank=1))
    made.add("a", "")
    assert list(made.lines(None)) == ["name", "a"]


def test_colours_only_where_asked_for() -> None:
    assert not any("\x1b" in line for line in table().lines(None))
    assert "\x1b[31;1mb/c" in list(table().lines(None, colour=True))[2]


def test_control_characters_do_not_reach_the_terminal() -> None:
    made = Table("name")
    made.add("a\x1b[2Jb\nc")
    assert list(made.lines(None)) == ["name", "a�[2Jb�c"]


@pytest.mark.parametrize(
    ("text", "width", "lines"),
    [
        ("one two three", 8, ["one two", "three"]),
        ("abcdefgh", 3, ["abc", "def", "gh"]),
        ("日本語", 4, ["日本", "語"]),
        ("", 5, []),
    ],
)
def test_lines_break_between_words(text: str, width: int, lines: list[str]) -> None:
    assert wrapped(text, width) == lines
    assert all(cells(line) <= width for line in lines)


def test_a_long_word_is_broken_into_lines() -> None:
    lines = wrapped("see " + "x" * 1_000_000, 80)
    assert lines[0] == "see"
    assert {len(line) for line in lines[1:]} == {80}
    assert "".join(lines[1:]) == "x" * 1_000_000
