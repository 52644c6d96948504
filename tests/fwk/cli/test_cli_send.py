"""`fwk send` builds messages from its arguments."""

import re
from pathlib import Path

import pytest

from fwk.cli.steer.send import made
from fwk.lcm.messages import MessageError, encode


def test_fields_are_set_by_name_and_others_are_zero() -> None:
    message = made("soccer.ball_placement_t", [])
    encode(message, "x")
    command = made("robot.motor_command_t", ["vx_m_s=1.5"])
    assert command.vx_m_s == 1.5
    encode(command, "x")
    nested = made("robot.motor_command_t", ["header.writer=me"])
    assert nested.header.writer == "me"


@pytest.mark.parametrize(
    ("fields", "error"),
    [
        (["vx_m_=1"], "robot.motor_command_t has no field 'vx_m_'; did you mean 'vx_m_s'?"),
        (["vx_m_s"], "'vx_m_s' is not FIELD=VALUE"),
        (["vx_m_s=[1"], "'vx_m_s=[1' is not FIELD=VALUE"),
        (["a.b=1"], "has no field 'a.b'"),
        (["vx_m_s=true"], "vx_m_s is true; it should be a number (double)"),
        (["enabled=1"], "enabled is 1; it should be true or false"),
        (["vx_m_s=1", "enabled=true", "vx_m_s=2"], "vx_m_s is given twice"),
    ],
)
def test_values_that_do_not_fit_are_named(fields: list[str], error: str) -> None:
    with pytest.raises(MessageError, match=re.escape(error)):
        made("robot.motor_command_t", fields)


@pytest.mark.parametrize("typed", ["5", "1e3", "on", "null", "", "{}", "[a, b]", "dummies: [cyan2]"])
def test_text_need_not_be_quoted(typed: str) -> None:
    assert made("soccer.play_scenario_t", [f"text={typed}"]).text == typed
    assert made("soccer.play_scenario_t", [f"text='{typed}'"]).text == typed


def test_text_of_a_file_is_taken_as_it_is(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text("# A shot.\nball: {x_m: 1.0}\n")
    assert made("soccer.play_scenario_t", [f"text=@{file}"]).text == file.read_text()
    with pytest.raises(MessageError, match=re.escape(f"text: {tmp_path}/no.yaml: No such file or directory")):
        made("soccer.play_scenario_t", [f"text=@{tmp_path}/no.yaml"])
    with pytest.raises(MessageError, match="/dev/zero: more than 1,000,000 letters are too many for a message"):
        made("soccer.play_scenario_t", ["text=@/dev/zero"])
    file.write_bytes(b"\xff")
    with pytest.raises(MessageError, match=r"mine\.yaml: .*utf-8"):
        made("soccer.play_scenario_t", [f"text=@{file}"])
