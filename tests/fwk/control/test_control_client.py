"""Which run is meant: the named one, or the only one."""

import re

import pytest

from fwk.control import address, client
from fwk.control.client import ControlError


@pytest.mark.parametrize(
    ("ports", "typed", "answer"),
    [
        ([], None, "nothing runs on this machine; start something with: fwk-launch FILE"),
        ([], 17700, "no run on this machine has --bus-port 17700"),
        ([1, 2], None, "several runs are on this machine; say which: --bus-port 1 or 2"),
        ([1], 2, "no run on this machine has --bus-port 2; there is one with --bus-port 1"),
    ],
)
def test_what_is_not_clear_is_asked(
    monkeypatch: pytest.MonkeyPatch, ports: list[int], typed: int | None, answer: str
) -> None:
    monkeypatch.setattr(address, "running", lambda: ports)
    with pytest.raises(ControlError, match=re.escape(answer)):
        client.find_run(typed)


@pytest.mark.parametrize(("ports", "typed", "found"), [([5], None, 5), ([5, 6], 6, 6)])
def test_the_only_one_or_the_named_one_is_found(
    monkeypatch: pytest.MonkeyPatch, ports: list[int], typed: int | None, found: int
) -> None:
    monkeypatch.setattr(address, "running", lambda: ports)
    assert client.find_run(typed) == found


def test_a_run_that_has_just_ended_does_not_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(address, "running", lambda: [1])
    with pytest.raises(ControlError, match="does not answer"):
        client.supervisor(1)
