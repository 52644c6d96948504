"""A word that is no command is explained with the command that was meant."""

import pytest

from fwk.cli.main import run


@pytest.mark.parametrize(
    ("typed", "right"),
    [
        ("set cyan1/agent.strategy=greedy", "no command 'fwk set'; did you mean 'fwk config set'?"),
        ("list", "no command 'fwk list'; did you mean 'fwk config list', 'fwk bb list' or 'fwk runs list'?"),
        ("echo cyan1/pose", "no command 'fwk echo'; did you mean 'fwk bb watch'?"),
        ("launch soccer.yaml", "no command 'fwk launch'; did you mean 'fwk-launch' or 'fwk new launch'?"),
        ("run soccer.yaml", "no command 'fwk run'; did you mean 'fwk-launch' or 'fwk runs'?"),
        ("stauts", "no command 'fwk stauts'; did you mean 'fwk status'?"),
        ("bb wach cyan1/pose", "no command 'fwk bb wach'; did you mean 'fwk bb watch'?"),
        ("new thing", "no command 'fwk new thing'; there are project, component, interface, launch"),
        ("qqq", "no command 'fwk qqq'; see 'fwk --help'"),
    ],
)
def test_unknown_command_names_the_right_one(typed: str, right: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(typed.split()) == 2
    assert capsys.readouterr().err == f"error: {right}\n"


@pytest.mark.parametrize("typed", ["bb", "bb list set", "config --help", "call set", "--nothing"])
def test_commands_and_options_are_left_to_typer(typed: str) -> None:
    with pytest.raises(SystemExit):
        run([*typed.split(), "--help"])
