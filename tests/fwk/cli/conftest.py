"""Fixtures of the tests of commands."""

from pathlib import Path

import pytest

from tests.fwk.cli.cli_eval_tools import LAUNCH


@pytest.fixture
def launch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Launch file that `fwk eval` measures, in the current folder."""
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "it.yaml"
    file.write_text(LAUNCH)
    return file
