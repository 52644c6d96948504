"""What is asked of the run's clock: to pause, to go on, to step, another speed."""

from collections.abc import Callable
from typing import Any

from fwk.clock import speed_word
from fwk.component.log import Logger
from fwk.control.requests import Clock, RequestError
from fwk.supervisor.loop import MainLoop

_WORDS = {"pause": "paused", "resume": "resumed", "step": "stepped", "speed": "run at another speed"}


class ClockControl:
    """Steers simulated time. None of this changes what components see: they know logical time alone."""

    def __init__(self, loop: MainLoop, log: Logger) -> None:
        self._loop = loop
        self._log = log

    def ask(self, wish: Clock) -> Callable[[], dict[str, Any] | None]:
        """Does it; what is returned gives the answer as soon as it has happened.

        Raises:
            RequestError: the run keeps the wall's clock.
        """
        pace = self._loop.pace
        if wish.verb == "speed" and wish.speed is None:
            return self.now
        if pace.wall:
            raise RequestError(
                f"the clock on the wall cannot be {_WORDS[wish.verb]}, and this run follows it; "
                "for a simulation say 'clock: simulated' in the launch file"
            )
        if wish.verb == "step":
            return self._step(wish.ticks)
        if wish.verb == "pause":
            pace.pause()
        elif wish.verb == "resume":
            pace.resume()
        elif wish.speed is not None:
            pace.speed = wish.speed
        self._log.info(f"asked to {wish.verb}{f' {speed_word(pace.speed)}' if wish.verb == 'speed' else ''}")
        return self._standing if wish.verb == "pause" else self.now

    def now(self) -> dict[str, Any]:
        """Where the clock is."""
        loop = self._loop
        paused = loop.stands and loop.pace.stands
        return {"tick": loop.tick, "time_us": loop.time_us, "paused": paused, "pace": loop.pace.speed}

    def _standing(self) -> dict[str, Any] | None:
        if self._loop.pace.stands and not self._loop.stands:
            return None
        return self.now()

    def _step(self, ticks: int) -> Callable[[], dict[str, Any] | None]:
        loop = self._loop
        last = loop.tick + ticks
        loop.stands = False
        loop.pace.step(ticks)
        return lambda: self.now() if loop.tick > last or (loop.tick == last and loop.stands) else self._overtaken()

    def _overtaken(self) -> dict[str, Any] | None:
        """Whoever paused meanwhile has the last word."""
        return self.now() if self._loop.pace.stands and self._loop.stands else None
