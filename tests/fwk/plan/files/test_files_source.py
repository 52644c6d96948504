"""YAML as launch files read it: plain values, and the line of each value."""

import os
from pathlib import Path

import pytest

from fwk.model.errors import PlanError, Problems
from fwk.plan.files.source import Node, read_value, read_yaml
from fwk.plan.load import load_plan


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e-3", 0.001),
        ("-.5", -0.5),
        (".inf", float("inf")),
        ("010", 10),
        ("0x1F", 31),
        ("true", True),
        ("yes", "yes"),
        ("on", "on"),
        ("12:30", "12:30"),
        ("2026-11-21", "2026-11-21"),
        ("1_000", "1_000"),
        ("'5'", "5"),
        ("", ""),
        ("~", None),
        ("[1, {a: b}]", [1, {"a": "b"}]),
        ("udpm://239.255.76.67:7667?ttl=0", "udpm://239.255.76.67:7667?ttl=0"),
    ],
)
def test_plain_values(text: str, value: object) -> None:
    problems = Problems()
    node = read_value(text, "--set", problems)
    assert node
    assert (node.plain(), bool(problems)) == (value, False)
    assert type(node.plain()) is type(value)


def test_every_value_knows_the_line_of_its_key(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text("one:\n  two: 2\n  three:\n    - x\n    - y\nfour: &f {five: 5}\nsix: *f\n")
    node = read_yaml(tmp_path / "a.yaml", "a.yaml", Problems())
    assert node
    paths: list[tuple[str | int, ...]] = [("one",), ("one", "two"), ("one", "three"), ("one", "three", 1), ("six",)]
    assert [node.at(*path).place for path in paths] == ["a.yaml:1", "a.yaml:2", "a.yaml:3", "a.yaml:5", "a.yaml:7"]
    assert node.at("one", "nothing", "deep").place == "a.yaml:1"
    assert node.at("six", "five") == Node(5, "a.yaml:6")


def test_a_pipe_without_data_is_refused_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.yaml")
    held_open = os.open(tmp_path / "pipe.yaml", os.O_RDWR)
    problems = Problems()
    assert read_yaml(tmp_path / "pipe.yaml", "pipe.yaml", problems) is None
    os.close(held_open)
    with pytest.raises(PlanError, match=r"^pipe\.yaml: cannot be read: it is not an ordinary file$"):
        problems.stop_if_any()


def test_a_file_of_ten_megabytes_is_refused_at_once(tmp_path: Path) -> None:
    (tmp_path / "big.yaml").write_text("components:\n" + "  a/b: { use: c }\n" * 600_000)
    problems = Problems()
    assert read_yaml(tmp_path / "big.yaml", "big.yaml", problems) is None
    with pytest.raises(PlanError, match=r"^big\.yaml: more than 1,000,000 bytes"):
        problems.stop_if_any()


def test_a_launch_file_that_is_a_pipe_is_named_as_such(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe.yaml")
    with pytest.raises(PlanError, match=r"^pipe.yaml: cannot be read: it is not an ordinary file$"):
        load_plan("pipe.yaml")
    with pytest.raises(PlanError, match="no such launch file") as missing:
        load_plan("pip.yaml")
    assert "pipe.yaml" not in str(missing.value)
