"""`fwk graph`, `fwk who` and single fields of messages."""

import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fwk.cli.commands import app
from fwk.cli.look.bb import field_of

FILE = str(Path(__file__).parents[3] / "launch/one-robot.yaml")


def said(*words: str) -> tuple[int, str]:
    result = CliRunner().invoke(app, words)
    return result.exit_code, result.output


def test_graph_of_a_launch_file_is_written_by_its_suffix(tmp_path: Path) -> None:
    for name, begin in (("g.svg", "<svg"), ("g.mmd", "flowchart LR"), ("g.txt", "outside:")):
        code, text = said("graph", "--file", FILE, "--out", str(tmp_path / name))
        assert (code, text.startswith(str(tmp_path / name))) == (0, True)
        assert (tmp_path / name).read_text().startswith(begin)
        assert text.endswith(" connections\n")
    small = said("graph", "cyan1/camera", "--file", FILE, "--out", str(tmp_path / "small.mmd"))[1]
    assert " components, " in small
    made = json.loads(said("graph", "cyan1/camera", "--file", FILE, "--json")[1])
    assert "cyan1/omni_ball" in {node["name"] for node in made["nodes"]}
    assert "cyan1/agent" not in {node["name"] for node in made["nodes"]}


def test_who_names_writer_and_readers() -> None:
    code, text = said("who", "cyan1/odometry", "--file", FILE)
    assert code == 0
    assert "written by  cyan1/base" in text
    (row,) = json.loads(said("who", "cyan1/odometry", "--file", FILE, "--json")[1])
    assert row["writer"] == "cyan1/base"


def test_unknown_names_are_answered_with_near_ones(tmp_path: Path) -> None:
    assert said("who", "cyan1/odometri", "--file", FILE) == (
        2,
        "error: no channel 'cyan1/odometri'; did you mean 'cyan1/odometry'?\n",
    )
    assert "did you mean 'cyan1/base'?" in said("graph", "cyan1/bas", "--file", FILE)[1]
    assert said("graph", "--file", "none.yaml")[0] == 2
    code, text = said("graph", "--file", FILE, "--out", str(tmp_path / "no" / "g.svg"))
    assert (code, "cannot be written: No such file or directory" in text) == (2, True)


@pytest.mark.parametrize("command", ["graph", "who"])
def test_a_launch_file_without_its_option_is_recognised(command: str) -> None:
    assert said(command, "robots.yaml") == (2, "error: 'robots.yaml' is a launch file; write: --file robots.yaml\n")


def test_field_is_found_by_its_path() -> None:
    value = {"pose": {"x_m": 1.5}, "robots": [{"y_m": 2.0}], "xs": [4, 5]}
    assert [field_of(value, path) for path in ("pose.x_m", "robots[0].y_m", "xs[1]")] == [1.5, 2.0, 5]


@pytest.mark.parametrize(
    ("path", "error"),
    [
        ("pose.x", "no field 'x' in 'pose.x'; there is x_m"),
        ("xs[2]", "no item '2' in 'xs[2]'; it has 1"),
        ("pose.x_m.y", "no field 'y' in 'pose.x_m.y'; it is a value without fields"),
    ],
)
def test_field_that_does_not_exist_is_named(path: str, error: str) -> None:
    with pytest.raises(LookupError, match=re.escape(error)):
        field_of({"pose": {"x_m": 1.5}, "xs": [4]}, path)
