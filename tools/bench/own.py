"""Arrangements of fwk alone: regularity in real time, start, memory, restart."""

from dataclasses import asdict, dataclass
from typing import Any, Literal


@dataclass(frozen=True)
class OwnScenario:
    """One arrangement of fwk alone."""

    name: str
    kind: Literal["jitter", "soak", "start"]
    components: int = 0
    """Jitter, soak: number of components."""
    stages: int = 5
    period_s: float = 0.0
    busy: bool = False
    """Jitter: whether every core has other work to do."""
    file: str = ""
    """Start: the launch file."""

    def job(self, seconds: float) -> dict[str, Any]:
        """Returns the description for the driver of such runs."""
        return {**asdict(self), "seconds": seconds}


AT_100_HZ = "100 Hz, N=20, idle cores"
SOAK = "100 Hz, N=20, long"
SOCCER = "soccer.yaml"

JITTER = (
    OwnScenario(AT_100_HZ, "jitter", components=20, period_s=0.01),
    OwnScenario("100 Hz, N=20, busy cores", "jitter", components=20, period_s=0.01, busy=True),
    OwnScenario("1 kHz, N=2, idle cores", "jitter", components=2, stages=1, period_s=0.001),
    OwnScenario("1 kHz, N=2, busy cores", "jitter", components=2, stages=1, period_s=0.001, busy=True),
)
LONG = (OwnScenario(SOAK, "soak", components=20, period_s=0.01),)
"""Measured once, and much longer than the others, for rare events."""
START = (
    OwnScenario(SOCCER, "start", file="soccer.yaml"),
    OwnScenario("soccer-1v1.yaml", "start", file="soccer-1v1.yaml"),
)
