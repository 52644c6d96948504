"""Pages to be followed, word for word: their files are written, their commands typed, their outputs compared."""

import re
import shlex
from pathlib import Path

import pytest

from tests.fwk.cli.cli_processes import run, write_files
from tests.harness.runs import PortBlock

DOCS = Path(__file__).parents[3] / "docs"
_FILE = re.compile(r"this as `([^`]+)`:\n\n```\w+\n(.*?)```", re.S)
_CONSOLE = re.compile(r"```console\n(.*?)```", re.S)


def steps(page: str) -> list[tuple[str, list[str]]]:
    """The commands in order, each with the lines that it should print; `...` stands for anything."""
    found: list[tuple[str, list[str]]] = []
    for line in "".join(_CONSOLE.findall(page)).splitlines():
        if line.startswith("$ "):
            found.append((line[2:], []))
        else:
            found[-1][1].append(line)
    return found


def shows(output: str, line: str) -> bool:
    """Whether a line of the page stands in the output."""
    wanted = ".*".join(map(re.escape, line.split("...")))
    return any(re.fullmatch(wanted, each) for each in output.splitlines())


@pytest.mark.system
@pytest.mark.parametrize(
    ("name", "n_files", "n_commands"),
    [
        ("first-component.md", 5, 7),
        ("commands-between-components.md", 5, 4),
        ("porting.md", 7, 4),
        ("devices.md", 3, 3),
    ],
)
def test_the_page_does_what_it_says(tmp_path: Path, ports: PortBlock, name: str, n_files: int, n_commands: int) -> None:
    page = (DOCS / name).read_text()
    files, commands = dict(_FILE.findall(page)), steps(page)
    assert len(files) == n_files
    assert len(commands) == n_commands
    write_files(tmp_path, files)
    for command, lines in commands:
        words = shlex.split(command)
        if words[0] == "fwk-launch":  # the one word added: beside other runs of this machine
            words += ["--bus-port", str(ports.bus)]
        result = run(tmp_path, *words)
        assert result.returncode == 0, f"{command}\n{result.stdout}"
        for line in lines:
            assert shows(result.stdout, line), f"{command}\ndoes not show: {line}\nbut: {result.stdout}"
