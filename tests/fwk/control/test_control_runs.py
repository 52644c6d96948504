"""Choice of the run for a command: the named one, the one in FWK_RUN, or the only one."""

import os
import re
from collections.abc import Callable
from typing import Any

import pytest

from fwk.control import address, runs
from fwk.control.client import Client, ControlError, RefusedError

RUNS = {1: {"name": "match", "plan": "soccer", "pid": 11}, 2: {"name": "solo", "plan": "soccer", "pid": 22}}


@pytest.fixture
def known(monkeypatch: pytest.MonkeyPatch) -> dict[int, dict[str, object]]:
    """The runs that exist; a test may add and remove some."""
    found: dict[int, dict[str, object]] = {port: dict(run) for port, run in RUNS.items()}
    monkeypatch.delenv(runs.RUN_VARIABLE, raising=False)
    monkeypatch.setattr(address, "running", lambda: sorted(found))
    monkeypatch.setattr(runs, "look", lambda: found)
    return found


@pytest.mark.parametrize(
    ("ports", "typed", "answer"),
    [
        ([], None, "nothing runs on this machine; start something with: fwk-launch FILE"),
        ([], "17700", "no run '17700' on this machine"),
        ([1], "", "a run has a name or a bus port, not ''"),
        ([1, 2], None, "several runs on this machine; choose one: --run match (soccer, pid 11) or --run solo"),
        ([1], "2", "no run '2' on this machine; there is --run match (soccer, pid 11)"),
        ([1], "mach", "no run 'mach' on this machine; there is --run match"),
    ],
)
def test_an_unclear_choice_is_refused(
    known: dict[int, dict[str, object]], ports: list[int], typed: str | None, answer: str
) -> None:
    for port in set(known) - set(ports):
        del known[port]
    with pytest.raises(ControlError, match=re.escape(answer)):
        runs.find(typed)


def test_runs_of_one_name_are_told_apart_by_port(known: dict[int, dict[str, object]]) -> None:
    known[2]["name"] = "match"
    with pytest.raises(RefusedError, match=r"several runs are called 'match'; .*--run 1 .* or --run 2 "):
        runs.find("match")


@pytest.mark.parametrize(("typed", "found"), [("solo", 2), ("match", 1), ("2", 2), (2, 2)])
def test_a_run_is_found_by_name_or_port(known: dict[int, dict[str, object]], typed: str | int, found: int) -> None:
    assert runs.find(typed) == found


def test_the_environment_names_the_default_run(
    known: dict[int, dict[str, object]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FWK_RUN", "solo")
    assert runs.find(None) == 2
    assert runs.find("match") == 1


def test_the_only_run_needs_no_name(known: dict[int, dict[str, object]]) -> None:
    del known[1]
    assert runs.find(None) == 2


def test_a_run_that_has_just_ended_does_not_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(address, "running", lambda: [1])
    with pytest.raises(ControlError, match="does not answer"):
        runs.supervisor("1")


def test_silent_and_false_runs_hide_no_other(fake: Callable[[bytes], str], monkeypatch: pytest.MonkeyPatch) -> None:
    real = b'{"ok": true, "name": "match", "plan": "soccer", "pid": 11}\n'
    sent = [b"", b"[]\n", b"", b'{"ok": true}\n', b" ", real]
    addresses = dict(enumerate(map(fake, sent)))
    monkeypatch.setattr(address, "running", lambda: list(addresses))
    monkeypatch.setattr(address, "supervisor_address", addresses.__getitem__)
    monkeypatch.setattr(runs, "LOOK_S", 0.2)
    ends_us: list[int | None] = []
    answer = Client.answer

    def noted(client: Client, end_us: int | None) -> dict[str, Any]:
        ends_us.append(end_us)
        return answer(client, end_us)

    monkeypatch.setattr(Client, "answer", noted)
    assert list(runs.look()) == [5]
    assert (len(ends_us), len(set(ends_us))) == (len(sent), 1)  # the silent ones are waited for together


def test_busy_run_is_found_by_name_although_it_was_silent(
    fake: Callable[[bytes], str], monkeypatch: pytest.MonkeyPatch
) -> None:
    found = fake(b'{"ok": true, "name": "solo", "plan": "soccer", "pid": 22}\n')
    monkeypatch.setattr(address, "running", lambda: [1, 2])
    monkeypatch.setattr(address, "supervisor_address", lambda port: found)
    monkeypatch.setattr(runs, "look", lambda: {1: RUNS[1]})
    assert runs.find("solo") == 2


def test_root_prefers_its_own_run(known: dict[int, dict[str, object]]) -> None:
    known[3] = {**known[1], "owner": os.geteuid()}
    assert runs.find("match") == 3
    assert runs.find(None) == 3
    assert runs.find("solo") == 2


@pytest.mark.parametrize(
    ("instead", "said"),
    [
        ("", "quiet has no public bus; its launch file sets 'public_url' to an empty text"),
        ("record it with --record", "quiet has no public bus; record it with --record"),
    ],
)
def test_run_without_a_public_bus_says_what_helps(instead: str, said: str) -> None:
    assert runs.public_bus({"plan": "loud", "public_url": "udpm://a"}, instead) == "udpm://a"
    with pytest.raises(ControlError) as refused:
        runs.public_bus({"plan": "quiet", "public_url": ""}, instead)
    assert str(refused.value) == said
