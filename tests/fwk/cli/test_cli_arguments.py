"""Values on the command line that are more than a number or a name."""

import pytest
import typer
from typer.testing import CliRunner

from fwk.cli.arguments import seconds, speed, spread
from fwk.cli.commands import app


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("soccer.yaml --only cyan1 world", "soccer.yaml --only cyan1 --only world"),
        ("--only cyan1 world soccer.yaml", "--only cyan1 --only world soccer.yaml"),
        ("--only a --only b f.yaml", "--only a --only b f.yaml"),
        ("f.yaml --without a b --ticks 3 --only c d", "f.yaml --without a --without b --ticks 3 --only c --only d"),
        ("f.yaml --only=a --ticks 3", "f.yaml --only=a --ticks 3"),
        ("f.yaml --set a=1 --seed 2", "f.yaml --set a=1 --seed 2"),
    ],
)
def test_names_in_a_row_follow_the_option_before_them(typed: str, meant: str) -> None:
    assert spread(typed.split()) == meant.split()


@pytest.mark.parametrize(("typed", "meant"), [("max", 0.0), ("1", 1.0), ("0.25", 0.25)])
def test_a_speed_is_a_factor_or_max(typed: str, meant: float) -> None:
    assert speed(typed) == meant


@pytest.mark.parametrize("typed", ["0", "-1", "fast", "nan", "inf", "1e-9", "1e30", ""])
@pytest.mark.parametrize("read", [speed, seconds])
def test_speeds_and_durations_that_no_clock_can_wait_for(read: type, typed: str) -> None:
    with pytest.raises(typer.BadParameter, match=f"'{typed}' is not a .*; use "):
        read(typed)


@pytest.mark.parametrize("words", [["completion", "tcsh"], ["log", "--level", "loud"]])
def test_a_value_that_is_not_a_choice_is_a_plain_sentence(words: list[str]) -> None:
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 2
    assert f"'{words[-1]}' is not one of" in result.output
    assert "Value error" not in result.output
