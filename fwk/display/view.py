"""What the display knows: newest messages, two statuses to take rates from, and the last log lines."""

from collections import deque
from typing import Any

from fwk.display.figures import LoopTime, loop_times
from fwk.display.scoreboard import Scoreboard
from fwk.lcm import envelope, messages
from fwk.model.plan import Plan
from lcmtypes.core import log_t, status_t

STATUS_CHANNEL = "fwk/status"
LOG_CHANNEL = "fwk/log"
_KEPT_LINES = 100
_RATE_STATUSES = 5  # loop times are means over as many statuses: about two seconds


class View:
    """Takes the supervisor's packets (channel, zero byte, encoded message) and answers questions about the run."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.lines: deque[log_t] = deque(maxlen=_KEPT_LINES)
        self._statuses: deque[status_t] = deque(maxlen=_RATE_STATUSES)
        self._types = {channel.name: channel.type_name for channel in plan.channels}
        self._raw: dict[str, bytes] = {}
        self._scoreboard = Scoreboard(plan.scoreboard)

    def take(self, packet: bytes) -> log_t | None:
        """Takes one packet; returns the log line if it was one.

        Raises:
            MessageError: a status or log line does not decode.
        """
        name, _, data = packet.partition(b"\0")
        channel = name.decode("utf-8", "replace")
        if channel == STATUS_CHANNEL:
            self._statuses.append(messages.decode(status_t, data, channel))
        elif channel == LOG_CHANNEL:
            line: log_t = messages.decode(log_t, data, channel)
            self.lines.append(line)
            return line
        else:
            self._raw[channel] = data  # decoded only if the scoreboard asks
        return None

    @property
    def status(self) -> status_t | None:
        """The newest status."""
        return self._statuses[-1] if self._statuses else None

    @property
    def loop_times(self) -> dict[str, LoopTime]:
        """Component to its loop time of the last two seconds."""
        return loop_times(self._statuses[-1], self._statuses[0]) if self._statuses else {}

    @property
    def headline(self) -> str:
        """The scoreboard's line."""
        return self._scoreboard.headline(self.newest)

    def newest(self, channel: str) -> Any:
        """The newest message of a channel, decoded, or None."""
        data = self._raw.get(channel)
        if data is None or channel not in self._types:
            return None
        return envelope.decode(messages.type_named(self._types[channel]), data, channel)
