"""Requests of the display to its run: components that the main loop waits for, and the effects of the keys."""

import os
import signal
from typing import Any

from fwk.control.address import supervisor_address
from fwk.control.client import Client, ControlError, NoAnswerError

_TIMEOUT_S = 0.3


class Steering:
    """Sends requests to the run that is shown; never waits for long. `said` is the newest answer as text."""

    def __init__(self, bus_port: int) -> None:
        self._address = supervisor_address(bus_port)
        self.said = ""

    def waits_for(self) -> list[str]:
        """Returns the components that the main loop waits for; empty if none, or if the run does not answer."""
        return list(self._ask("status").get("waits_for", []))

    def toggle_pause(self, paused: bool) -> None:
        """Pauses the run, or resumes it."""
        self._clock("resume" if paused else "pause")

    def step(self) -> None:
        """Runs one tick, and pauses."""
        self._clock("step", ticks=1)

    def change_speed(self, speed: float) -> None:
        """Sets the speed; 0: as fast as possible."""
        self._clock("speed", speed=speed)

    def speed(self) -> float | None:
        """Returns the wanted speed, 0: as fast as possible; None if the run does not answer."""
        pace = self._ask("status").get("pace")
        return pace if isinstance(pace, int | float) else None

    def quit(self) -> None:
        """Ends the run, as Ctrl-C does."""
        self.said = "ending the run"
        os.kill(os.getppid(), signal.SIGINT)

    def _clock(self, verb: str, **fields: Any) -> None:
        self.said = ""
        self._ask(verb, **fields)

    def _ask(self, verb: str, **fields: Any) -> dict[str, Any]:
        try:
            with Client(self._address, _TIMEOUT_S) as run:
                return run.ask(verb, _TIMEOUT_S, **fields)
        except NoAnswerError:  # it takes effect at the end of the running tick
            return {}
        except (ControlError, ValueError) as error:
            self.said = str(error)
            return {}
