"""`fwk log` shows the whole lines of any text log."""

import json
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as some
from typer.testing import CliRunner

from fwk.cli.commands import app as fwk
from fwk.logs.reader import read_lines

GOOD = {"level": "info", "component": "a/b", "tick": 5, "time_us": 1, "wall_us": 1, "file": "f", "line": 1, "text": "t"}
VALUES: some.SearchStrategy[Any] = (
    some.none() | some.integers() | some.floats() | some.text(max_size=5) | some.sampled_from([[], {}])
)


def check(folder: Path, before: bytes) -> None:
    (folder / "fwk.log.jsonl").write_bytes(before + b"\n" + json.dumps(GOOD).encode() + b"\n")
    assert list(read_lines(folder / "fwk.log.jsonl"))[-1] == GOOD
    for options in ([], ["--json"], ["--level", "info", "--component", "a", "--tick", "5", "--text", "t"]):
        shown = CliRunner().invoke(fwk, ["log", str(folder), *options])
        assert shown.exit_code == 0, (before, shown.exception)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(some.binary(max_size=40) | some.text(alphabet='[]{}",:0a', max_size=40).map(str.encode))
@example(b"[" * 100_000)
def test_any_bytes_are_allowed_in_a_text_log(tmp_path: Path, junk: bytes) -> None:
    check(tmp_path, junk)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(some.dictionaries(some.sampled_from(list(GOOD)), VALUES, max_size=3), some.sampled_from([*GOOD, ""]))
@example({"wall_us": 10**19}, "")
def test_any_object_is_allowed_in_a_text_log(tmp_path: Path, changed: dict[str, Any], left_out: str) -> None:
    line = {key: value for key, value in {**GOOD, **changed}.items() if key != left_out}
    check(tmp_path, json.dumps(line).encode())
