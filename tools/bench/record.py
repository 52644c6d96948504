"""Parameters and results of one benchmark, kept as JSON so that tables can be made again."""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

from tools.bench.figures import Run
from tools.bench.own import JITTER, START, OwnScenario
from tools.bench.registry import PEERS, Peer
from tools.bench.scenarios import Scenario, growth, variations


@dataclass(frozen=True)
class Record:
    """One benchmark."""

    about: dict[str, str]
    """Command and machine."""
    missing: dict[str, str]
    """Peers that were left out, with the reason."""
    peer_names: Sequence[str]
    sizes: Sequence[int]
    varied: Sequence[int]
    """Sizes of the runs with ten reads, large messages and loss."""
    with_own: bool
    """Whether real time, start, memory and restart of fwk were measured."""
    runs: list[Run] = field(default_factory=list)

    @property
    def peers(self) -> list[Peer]:
        """The peers that took part."""
        return [PEERS[name] for name in self.peer_names]

    @property
    def scenarios(self) -> list[Scenario]:
        """The arrangements of all peers."""
        return [*growth(tuple(self.sizes)), *variations(tuple(self.varied))]

    @property
    def own(self) -> Sequence[OwnScenario]:
        """The arrangements of fwk alone."""
        return (*JITTER, *START) if self.with_own else ()

    def save(self, path: Path) -> None:
        """Writes everything, with the wall time of every tick."""
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(asdict(self)))

    @classmethod
    def read(cls, path: Path) -> "Record":
        """Reads a file of `save`."""
        data = json.loads(path.read_text())
        return cls(**{**data, "runs": [Run(**run) for run in data["runs"]]})
