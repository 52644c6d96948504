"""The order of runs."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

from tools.bench import rotation
from tools.bench.__main__ import measure
from tools.bench.environments import CORE
from tools.bench.figures import Run
from tools.bench.own import OwnScenario
from tools.bench.record import Record
from tools.bench.registry import Peer
from tools.bench.scenarios import Scenario, growth

PEERS = [Peer(name, name, CORE, "") for name in ("a", "b", "c")]


@pytest.fixture
def pretend(monkeypatch: pytest.MonkeyPatch) -> None:
    def run(_words: list[str], _number: int, peer: Peer, scenario: Scenario, _seconds: float) -> dict[str, Any]:
        failed = peer.name == "b" and scenario.name == "N=20"
        return {"error": "no first tick"} if failed else {"tick_us": [1.0]}

    monkeypatch.setattr(rotation, "_run", run)
    monkeypatch.setattr(rotation, "isolation", list)


@pytest.mark.usefixtures("pretend")
def test_peers_change_positions_from_round_to_round() -> None:
    seen: list[Run] = []
    rotation.rotate(PEERS, growth((5,)), 4, 1.0, seen.append)
    assert ["".join(run.peer for run in seen if run.round == number) for number in range(4)] == [
        "abc",
        "bca",
        "cab",
        "abc",
    ]


@pytest.mark.usefixtures("pretend")
def test_a_peer_that_failed_twice_is_not_tried_again() -> None:
    runs = rotation.rotate(PEERS, growth((5, 20)), 5, 1.0, lambda _: None)
    assert len([run for run in runs if (run.peer, run.scenario) == ("b", "N=20")]) == 2
    assert len([run for run in runs if (run.peer, run.scenario) == ("b", "N=5")]) == 5
    assert len([run for run in runs if (run.peer, run.scenario) == ("a", "N=20")]) == 5


@pytest.mark.parametrize(("with_own", "lengths_s"), [(True, [2.0, 600.0]), (False, [])])
def test_long_run_belongs_to_those_of_fwk_alone(
    with_own: bool, lengths_s: list[float], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    played_s = []

    def play(scenarios: Sequence[OwnScenario], _rounds: int, seconds: float, _take: Callable[[Run], None]) -> None:
        played_s.extend([seconds] if scenarios else [])

    monkeypatch.setattr(rotation, "rotate_own", play)
    record = Record({}, {}, [], (), (), with_own)
    measure(record, rounds=1, seconds=0.1, soak_s=600.0, json_file=tmp_path / "runs.json")
    assert played_s == lengths_s
