"""State and figures of the components of a host."""

from collections.abc import Callable
from dataclasses import dataclass, field

from fwk.model.histogram import Histogram
from lcmtypes.core import component_state_t, histogram_t

TEXT_CHARACTERS = 1000
"""Longest text of an exception in a reason; the log has all of it."""


@dataclass
class ComponentMetrics:
    """State and figures of one component."""

    name: str
    now_us: Callable[[], int]
    """Returns the wall time."""
    state: str = "loaded"
    reason: str = ""
    times: Histogram = field(default_factory=Histogram)
    """Durations of its iterations."""

    def __post_init__(self) -> None:
        self._since_us = self.now_us()

    def message(self) -> component_state_t:
        """Returns state and figures as the host reports them."""
        made = component_state_t()
        made.name, made.state, made.reason = self.name, self.state, self.reason
        made.iterations, made.busy_us, made.worst_us = self.times.count, self.times.total_us, self.times.worst_us
        made.awake_us = self.now_us() - self._since_us
        return made

    def histogram(self) -> histogram_t:
        """Returns the durations of the iterations as the host reports them."""
        made = histogram_t()
        made.bucket, made.count = list(self.times.counts), list(self.times.counts.values())
        return made


def told(error: BaseException) -> str:
    """Returns an exception as one line of text that can be sent, even if its own text cannot be made."""
    try:
        text = str(error)
    except Exception as worse:
        text = f"its text cannot be made ({type(worse).__name__})"
    if len(text) > TEXT_CHARACTERS:
        text = f"{text[:TEXT_CHARACTERS]} ... ({len(text) - TEXT_CHARACTERS} characters more)"
    plain = text.encode(errors="backslashreplace").decode().replace("\0", "\\0")  # characters that can be sent
    return f"{type(error).__name__}: {plain}"
