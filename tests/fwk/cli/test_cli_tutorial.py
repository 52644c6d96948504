"""Tutorial pages, followed word for word: files are written, commands typed, outputs compared.

tests/packaging follows the first tutorial with the wheel in a fresh environment.
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
    [
        ("commands-between-components.md", 5, 4),
        ("porting.md", 7, 4),
        ("devices.md", 3, 3),
        ("generator.md", 0, 10),
        ("other-languages.md", 7, 4),
    ],
)
def test_the_page_works_word_for_word(
    tmp_path: Path, ports: PortBlock, name: str, n_files: int, n_commands: int
) -> None:
    page = Page(name)
    assert (len(page.files), len(page.steps)) == (n_files, n_commands)
    write_files(tmp_path, page.files)
    for command, lines in page.steps:
        words = shlex.split(command)
        if words[0] == "fwk-launch":  # the only word added, because other runs use this machine
            words += ["--bus-port", str(ports.bus)]
        result = run(tmp_path, *words)
        assert result.returncode == 0, f"{command}\n{result.stdout}"
        for line in lines:
            assert shows(result.stdout, line), f"{command}\ndoes not show: {line}\nbut: {result.stdout}"
