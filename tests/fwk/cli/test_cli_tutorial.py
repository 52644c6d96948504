"""Pages to be followed, word for word: their files are written, their commands typed, their outputs compared.

The tutorial itself is followed in tests/packaging, with the wheel in a fresh environment.
"""

import shlex
from pathlib import Path

import pytest

from tests.fwk.cli.cli_processes import run, write_files
from tests.harness.pages import Page, shows
from tests.harness.runs import PortBlock


@pytest.mark.system
@pytest.mark.parametrize(
    ("name", "n_files", "n_commands"),
    [("commands-between-components.md", 5, 4), ("porting.md", 7, 4), ("devices.md", 3, 3)],
)
def test_the_page_does_what_it_says(tmp_path: Path, ports: PortBlock, name: str, n_files: int, n_commands: int) -> None:
    page = Page(name)
    assert (len(page.files), len(page.steps)) == (n_files, n_commands)
    write_files(tmp_path, page.files)
    for command, lines in page.steps:
        words = shlex.split(command)
        if words[0] == "fwk-launch":  # the one word added: beside other runs of this machine
            words += ["--bus-port", str(ports.bus)]
        result = run(tmp_path, *words)
        assert result.returncode == 0, f"{command}\n{result.stdout}"
        for line in lines:
            assert shows(result.stdout, line), f"{command}\ndoes not show: {line}\nbut: {result.stdout}"
