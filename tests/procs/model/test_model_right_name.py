"""Names that are right in the place of an unknown one."""

import pytest

from procs.model.right_name import right_name

COMMANDS = ("kickoff", "freekick", "start", "stop", "reset")


@pytest.mark.parametrize(
    ("word", "right"),
    [
        ("kickof", "did you mean 'kickoff'?"),
        ("KICKOFF", "did you mean 'kickoff'?"),
        ("Reset", "did you mean 'reset'?"),
        ("xyz", "there are kickoff, freekick, start, stop, reset"),
    ],
)
def test_nearest_name_is_right_in_any_capitals(word: str, right: str) -> None:
    assert right_name(word, COMMANDS) == right


def test_no_name_is_right_if_there_is_none() -> None:
    assert right_name("cyan1", ()) == "there are none"
