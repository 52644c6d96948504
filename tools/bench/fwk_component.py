"""The benchmark's work as components of fwk: relays that read some channels and write one, and a probe of periods."""

import json
from pathlib import Path

from lcmtypes.bench import sample_t

from fwk import Clock, Component, Config, Reads, Writes
from tools.bench.sample import fill
from tools.bench.shape import Shape
from tools.bench.timing import now_us


class RelayConfig(Config):
    """Component and shape."""

    index: int
    shape_file: str


class Relay(Component):
    """Does the work of `tools.bench.component` without the ports; the launch file gives it its stage."""

    stage = "s0"
    config: RelayConfig
    clock: Clock
    out: Writes[sample_t]

    def init(self) -> None:
        shape = Shape.read(self.config.shape_file)
        self._shape = shape
        self._sources: list[tuple[int, Reads[sample_t]]] = [
            (source, getattr(self, f"in{number}")) for number, source in enumerate(shape.sources(self.config.index))
        ]
        self._stage = shape.stage(self.config.index)
        self._padding = bytes(shape.padding_bytes)
        self._iterations = self._stale = 0

    def loop(self) -> None:
        read = [port.value for _, port in self._sources]
        for (source, _), sample in zip(self._sources, read, strict=True):
            self._stale += sample.header.tick < self._shape.expected_tick(self.config.index, source, self.clock.tick)
        fill(self.out.value, self.config.index, self.clock.tick, self._stage, read, self._padding)
        self.out.write()
        self._iterations += 1

    def finalize(self) -> None:
        counts = {"iterations": self._iterations, "stale": self._stale}
        Path(self._shape.folder, f"component{self.config.index}.json").write_text(json.dumps(counts))


class Relay1(Relay):
    """Reads one channel."""

    in0: Reads[sample_t]


class Relay4(Relay):
    """Reads four channels."""

    in0: Reads[sample_t]
    in1: Reads[sample_t]
    in2: Reads[sample_t]
    in3: Reads[sample_t]


class Relay10(Relay4):
    """Reads ten channels."""

    in4: Reads[sample_t]
    in5: Reads[sample_t]
    in6: Reads[sample_t]
    in7: Reads[sample_t]
    in8: Reads[sample_t]
    in9: Reads[sample_t]


class Probe(Relay1):
    """A relay that also notes the beginning of each of its iterations."""

    def init(self) -> None:
        super().init()
        self._began_us: list[int] = []

    def loop(self) -> None:
        self._began_us.append(now_us())
        super().loop()

    def finalize(self) -> None:
        super().finalize()
        Path(self._shape.folder, "probe.json").write_text(json.dumps(self._began_us))
