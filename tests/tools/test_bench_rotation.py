"""The order of runs."""

from typing import Any

import pytest

from tools.bench import rotation
from tools.bench.environments import CORE
from tools.bench.figures import Run
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
