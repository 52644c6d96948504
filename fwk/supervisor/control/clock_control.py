"""Control requests for the run's clock: pause, resume, step, speed."""

from collections.abc import Callable
from typing import Any

from fwk.clock import speed_word
from fwk.component.log import Logger
from fwk.control.requests import RequestError, SetClock
from fwk.supervisor.loop import Loop
from fwk.supervisor.run_clock import RunClock

_WORDS = {"pause": "paused", "resume": "resumed", "step": "stepped", "speed": "run at another speed"}


class ClockControl:
    """Controls simulated time. Components see logical time alone, so none of this changes what they see."""

    def __init__(self, loop: Loop, clock: RunClock, log: Logger) -> None:
        self._loop = loop
        self._run_clock = clock
        self._log = log

    def ask(self, request: SetClock) -> Callable[[], dict[str, Any] | None]:
        """Carries a request out; the returned function gives the reply as soon as the request has taken effect.

        Raises:
            RequestError: the run follows the wall clock.
        """
        clock = self._run_clock
        if request.verb == "speed" and request.speed is None:
            return self.now
        if clock.wall:
            raise RequestError(
                f"the wall clock cannot be {_WORDS[request.verb]}, and this run follows it; "
                "for a simulation set 'clock: simulated' in the launch file"
            )
        if request.verb == "step":
            self._log.info(f"asked to step {request.ticks} {'tick' if request.ticks == 1 else 'ticks'}")
            return self._step(request.ticks)
        if request.verb == "pause":
            clock.pause()
        elif request.verb == "resume":
            clock.resume()
        elif request.speed is not None:
            clock.speed = request.speed
        self._log.info(f"asked to {request.verb}{f' {speed_word(clock.speed)}' if request.verb == 'speed' else ''}")
        return self._standing if request.verb == "pause" else self.now

    def now(self) -> dict[str, Any]:
        """Returns tick, logical time, speed, and whether the run is paused."""
        loop = self._loop
        clock = self._run_clock
        paused = loop.paused and clock.stands
        return {"tick": loop.tick, "time_us": clock.time_us, "paused": paused, "pace": clock.speed}

    def _standing(self) -> dict[str, Any] | None:
        if self._run_clock.stands and not self._loop.paused:
            return None
        return self.now()

    def _step(self, ticks: int) -> Callable[[], dict[str, Any] | None]:
        loop = self._loop
        last = loop.tick + ticks
        loop.paused = False
        self._run_clock.step(ticks)
        return lambda: self.now() if loop.tick > last or (loop.tick == last and loop.paused) else self._overtaken()

    def _overtaken(self) -> dict[str, Any] | None:
        """Returns the reply if a later pause has taken precedence."""
        return self.now() if self._run_clock.stands and self._loop.paused else None
