"""Command lines of `fwk web` that are refused."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from fwk.cli.commands import app


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--address", "192.168.1.5"), "--address 192.168.1.5: other machines reach it, so it needs TLS"),
        (("--address", "0.0.0.0", "--certificate", "pem", "--key", "pem"), "links need one; add --name"),
        (("--address", "::", "--certificate", "pem", "--key", "pem"), "links need one; add --name"),
        (("--certificate", "pem", "--key", "pem"), "for addresses beyond this machine; leave them out"),
        (("--name", "my robot"), "--name 'my robot': not the name of a machine, such as robot or robot.local"),
    ],
)
def test_mistakes_name_what_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], says: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("pem").write_text("")
    result = CliRunner().invoke(app, ["web", *words])
    assert result.exit_code == 2
    assert says in " ".join(result.output.replace("│", " ").split())
