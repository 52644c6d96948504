"""The supervisor's process: python -m tools.bench.supervise PEER SHAPE_FILE; the driver commands it over a socket."""

import json
import socket
import sys
from pathlib import Path
from typing import Any

from tools.bench.shape import LAST_WARM_UP_TICK, Shape
from tools.bench.sides import STOP, SupervisorSide, load
from tools.bench.timing import now_us

WARM_UP_TICKS = 20
WARM_UP_US = 1_000_000  # eCAL and ROS connect readers to writers while ticks already run
_REPEAT_S = 0.005  # first repetition of a tick; doubled each time
_REPEAT_MAX_S = 0.2
_GIVE_UP_S = 80.0


class NoAnswerError(Exception):
    """Components did not answer a tick; the text names them."""


def main() -> None:
    """Warms up, then runs the ticks that the driver requests, until the end of the run."""
    peer, shape = sys.argv[1], Shape.read(sys.argv[2])
    control = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    control.connect(str(Path(shape.folder, "control")))
    lines = control.makefile("rw")

    def answer(what: dict[str, Any]) -> None:
        lines.write(json.dumps(what) + "\n")
        lines.flush()

    side = load(peer).supervisor(shape)
    try:
        run_tick(side, shape, 1)
        first_us = now_us()
        tick = 1
        while tick < WARM_UP_TICKS or now_us() < first_us + WARM_UP_US:
            tick += 1
            run_tick(side, shape, tick)
        run_tick(side, shape, LAST_WARM_UP_TICK)
        answer({"first_tick_us": first_us})
        tick = LAST_WARM_UP_TICK
        for line in lines:
            words = line.split()
            if words[0] == "stop":
                break
            result = measure(side, shape, tick, int(words[1]), float(words[2]))
            tick += len(result["tick_us"])
            answer(result)
    except NoAnswerError as error:
        answer({"error": str(error)})
    for _ in range(3):  # a lost one would leave a component behind
        for stage in range(shape.stages):
            side.begin(stage, STOP)
    side.close()


def measure(side: SupervisorSide, shape: Shape, tick: int, ticks: int, seconds: float) -> dict[str, Any]:
    """Runs `ticks` ticks after `tick`, or as many as `seconds` allow; returns wall times in µs, and repeated stages."""
    tick_us = []
    repeated = 0
    end_us = now_us() + int(seconds * 1e6)
    for number in range(tick + 1, tick + ticks + 1):
        start_us = now_us()
        if start_us > end_us:
            break
        repeated += run_tick(side, shape, number)
        tick_us.append(now_us() - start_us)
    return {"tick_us": tick_us, "repeated": repeated}


def run_tick(side: SupervisorSide, shape: Shape, tick: int) -> int:
    """Runs one pass of all stages; returns how often a stage was repeated because an answer was missing.

    Raises:
        NoAnswerError: components stayed silent.
    """
    repeated = 0
    for stage in range(shape.stages):
        waiting = set(shape.members(stage))
        if not waiting:
            continue
        start_us, patience_s = now_us(), _REPEAT_S
        side.begin(stage, tick)
        while waiting:
            answer = side.done(patience_s)
            if answer is not None:
                if answer[1] == tick:
                    waiting.discard(answer[0])
                continue
            if now_us() - start_us > _GIVE_UP_S * 1e6:
                silent = ", ".join(f"c{index}" for index in sorted(waiting)[:5])
                raise NoAnswerError(f"tick {tick}, stage {stage}: no answer from {len(waiting)} components: {silent}")
            repeated += 1
            patience_s = min(2 * patience_s, _REPEAT_MAX_S)
            side.begin(stage, tick)
    return repeated


if __name__ == "__main__":
    main()
