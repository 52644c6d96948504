"""One arrangement: number of components and stages, readers of each component, size of messages."""

import json
from dataclasses import asdict, dataclass
from pathlib import Path

LAST_WARM_UP_TICK = 1_000_000
"""Number of the last tick that does not count, by which processes know whether a tick is measured."""


@dataclass(frozen=True)
class Shape:
    """The data flow that every peer carries out in the same way.

    Component i runs in stage i mod `stages`, reads the newest messages of the `reads` components before it (in a
    cycle) and writes one message. So most components read messages of the stage before in the same tick, and those of
    the first stage read messages of the last stage of the tick before.
    """

    components: int
    stages: int = 5
    reads: int = 1
    padding_bytes: int = 0
    base_port: int = 17000
    folder: str = ""
    """Folder in which processes of the run leave files for each other."""

    @property
    def name(self) -> str:
        """Short name for tables: `N=20`, `N=20 reads=10`."""
        parts = [f"N={self.components}"]
        parts += [f"reads={self.reads}"] if self.reads != 1 else []
        parts += [f"{self.padding_bytes // 1024} KiB"] if self.padding_bytes else []
        return " ".join(parts)

    @property
    def fragments(self) -> int:
        """Datagrams of one message in LCM's format."""
        return 1 + self.padding_bytes // 65_000

    def stage(self, component: int) -> int:
        """The stage in which a component runs."""
        return component % self.stages

    def members(self, stage: int) -> list[int]:
        """The components of a stage."""
        return list(range(stage, self.components, self.stages))

    def sources(self, component: int) -> list[int]:
        """The components whose messages it reads; never itself."""
        reads = min(self.reads, self.components - 1)
        return [(component - 1 - back) % self.components for back in range(reads)]

    def readers(self, component: int) -> list[int]:
        """The components that read its message."""
        return [other for other in range(self.components) if component in self.sources(other)]

    def expected_tick(self, component: int, source: int, tick: int) -> int:
        """The tick of the newest message of `source` that a component should see in its iteration of `tick`."""
        return tick if self.stage(source) < self.stage(component) else tick - 1

    def save(self) -> str:
        """Writes the shape into its folder for the run's processes; returns the file's path."""
        path = Path(self.folder, "shape.json")
        path.write_text(json.dumps(asdict(self)))
        return str(path)

    @classmethod
    def read(cls, path: str) -> "Shape":
        """Reads back what `save` wrote."""
        return cls(**json.loads(Path(path).read_text()))
