"""`fwk spy` listens on the public bus of the run that is meant."""

from typing import Any

import pytest
import typer

from fwk.cli.look import spy
from fwk.control import runs as control_runs
from fwk.control.client import RefusedError
from fwk.model.plan import Plan


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> dict[str, str]:
    """The public buses of the runs of this machine, by name."""
    urls: dict[str, str] = {}

    def ask(chosen: str | None, verb: str) -> dict[str, Any]:
        if chosen is None and len(urls) > 1:
            raise RefusedError("several runs on this machine; choose one")
        name = chosen or next(iter(urls))
        return {"plan": name, "public_url": urls[name]}

    monkeypatch.setattr(spy, "ask", ask)
    monkeypatch.setattr(control_runs, "meant", lambda: list(range(len(urls))))
    return urls


def test_spy_listens_to_the_run_that_is_meant(runs: dict[str, str]) -> None:
    assert spy.bus_of(None) == Plan.public_url
    runs["red"] = "udpm://239.255.76.67:8767?ttl=0"
    assert spy.bus_of(None) == runs["red"]
    runs["blue"] = "udpm://239.255.76.67:8768?ttl=0"
    assert spy.bus_of("blue") == runs["blue"]


@pytest.mark.parametrize(
    ("urls", "code", "said"),
    [
        ({"red": "udpm://a", "blue": "udpm://b"}, 2, "several runs on this machine; choose one"),
        ({"red": ""}, 1, "red has no public bus"),
    ],
)
def test_spy_without_a_bus_says_why(
    runs: dict[str, str], urls: dict[str, str], code: int, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    runs.update(urls)
    with pytest.raises(typer.Exit) as ended:
        spy.bus_of(None)
    assert (ended.value.exit_code, said in capsys.readouterr().err) == (code, True)
