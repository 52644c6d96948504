"""One component's process: python -m tools.bench.component PEER SHAPE_FILE INDEX."""

import ctypes
import json
import signal
import sys
from pathlib import Path

from tools.bench.sample import fill
from tools.bench.shape import LAST_WARM_UP_TICK, Shape
from tools.bench.sides import STOP, ComponentSide, load

_PR_SET_PDEATHSIG = 1


def main() -> None:
    """Runs until the supervisor ends it; then writes the number of stale inputs to a file."""
    peer, shape, index = sys.argv[1], Shape.read(sys.argv[2]), int(sys.argv[3])
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)  # no process is left behind when the run is killed
    side = load(peer).component(shape, index)
    iterations, stale = run(side, shape, index)
    Path(shape.folder, f"component{index}.json").write_text(json.dumps({"iterations": iterations, "stale": stale}))
    side.close()


def run(side: ComponentSide, shape: Shape, index: int) -> tuple[int, int]:
    """Runs the loop; returns iterations and the number of inputs older than the newest of the earlier stages.

    A repeated tick is answered again and not run again.
    """
    padding = bytes(shape.padding_bytes)
    sources = shape.sources(index)
    stage = shape.stage(index)
    last = iterations = stale = 0
    while (tick := side.tick()) != STOP:
        if tick > last:
            read = side.inputs()
            for source, sample in zip(sources, read, strict=True):
                found = sample.header.tick if sample is not None else 0
                stale += tick > LAST_WARM_UP_TICK and found < shape.expected_tick(index, source, tick)
            made = side.new_sample()
            fill(made, index, tick, stage, read, padding)
            side.publish(made)
            last = tick
            iterations += 1
        side.done(tick)
    return iterations, stale


if __name__ == "__main__":
    main()
