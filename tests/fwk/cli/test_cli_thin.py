"""Thin commands (help, version, status, ps and completion) import no heavy library."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from fwk.cli import commands, index, reference
from fwk.cli.thin import FUNCTIONS, prepared

HEAVY = {"numpy", "pydantic", "cv2", "typer", "click", "rich", "yaml", "lcm", "asyncio"}
SLOW = {"dataclasses", "inspect", "pathlib"}
PROGRAM = """
import sys
sys.argv = ["fwk", *sys.argv[1:]]
from fwk.cli.main import main
try:
    main()
finally:
    print("IMPORTED", *sorted(sys.modules), file=sys.stderr)
"""


@pytest.mark.parametrize(
    "typed", ["--help", "--version", "status", "ps", "ps --json", "__complete fwk st", "__complete fwk-launch --"]
)
def test_no_heavy_module_is_imported(typed: str, tmp_path: Path) -> None:
    done = subprocess.run([sys.executable, "-c", PROGRAM, *typed.split()], capture_output=True, text=True, check=False)
    imported = next(line for line in done.stderr.splitlines() if line.startswith("IMPORTED")).split()
    refused = HEAVY if typed.startswith(("--version", "__complete")) else HEAVY | SLOW
    assert not set(imported) & refused
    assert "fwk.cli.commands" not in imported


@pytest.mark.slow
@pytest.mark.parametrize("typed", ["config list", "config set a/b.c=1", "bb list", "log", "stop --all", "runs list"])
def test_looks_at_a_run_import_nothing_that_computes(typed: str, tmp_path: Path) -> None:
    command = [sys.executable, "-c", PROGRAM, *typed.split(), *(["--run", "none"] if typed != "runs list" else [])]
    environment = {**os.environ, "HOME": str(tmp_path)}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    imported = next(line for line in done.stderr.splitlines() if line.startswith("IMPORTED")).split()
    assert not set(imported) & {"numpy", "cv2", "lcm", "yaml"}


def test_the_index_agrees_with_the_commands() -> None:
    assert Path(index.FILE).read_text() == reference.index(), "run: make docs"


def test_every_command_is_in_the_help() -> None:
    done = subprocess.run([sys.executable, "-m", "fwk.cli.main", "--help"], capture_output=True, text=True, check=True)
    named = {line.split()[0] for line in done.stdout.splitlines() if line.startswith("  ")}
    assert set(commands.MODULES) <= named


@pytest.mark.parametrize("typed", ["status --jso", "status --run", "status --help", "ps x", "runs list"])
def test_mistakes_and_other_commands_are_left_to_typer(typed: str) -> None:
    assert prepared(typed.split()) is None


def test_words_of_a_thin_command_are_read() -> None:
    command = next(each for each in index.read() if each.words == ("fwk", "status"))
    from fwk.cli.thin import arguments

    values = arguments(command, ["a/b", "--run=match", "--json", "c/*"])
    assert values == {"names": ["a/b", "c/*"], "chosen": "match", "as_json": True}


def test_every_thin_command_is_a_command() -> None:
    assert set(FUNCTIONS) <= set(commands.MODULES)


def test_a_named_run_that_does_not_exist_is_bad_input(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "fwk.cli.main", "status", "--run", "no-such-run"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("error: no run 'no-such-run' on this machine")


def test_runs_are_listed_for_programs(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "fwk.cli.main", "ps", "--json"]
    assert isinstance(json.loads(subprocess.check_output(command, text=True, env={**os.environ})), list)
