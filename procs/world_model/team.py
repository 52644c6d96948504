"""What the team mates last said of themselves."""

from dataclasses import dataclass

import numpy as np

from procs.model.frames import Floats

_TOLD_M = 0.05  # accuracy of a mate's position when it was told
_DRIFT_M_S = 0.5  # and how fast it gets worse
_EXTRAPOLATED_S = 0.5  # a velocity is not believed for longer


@dataclass(frozen=True)
class Mate:
    """A team mate as it was at `told_s`, world frame."""

    name: str
    role: str
    told_s: float
    position_m: Floats
    heading_rad: float
    velocity_m_s: Floats
    localized: bool

    def position_at(self, now_s: float) -> Floats:
        """Where it probably is now (2)."""
        return self.position_m + self.velocity_m_s * min(now_s - self.told_s, _EXTRAPOLATED_S)

    def covariance_at(self, now_s: float) -> Floats:
        """Covariance (2, 2) of that, in m²."""
        return np.eye(2) * (_TOLD_M + _DRIFT_M_S * (now_s - self.told_s)) ** 2


class Team:
    """The newest word of each mate, until the time-out."""

    def __init__(self) -> None:
        self._mates: dict[str, Mate] = {}

    def tell(self, mate: Mate) -> bool:
        """A mate spoke; false if it is older than what is known: radio may change the order."""
        known = self._mates.get(mate.name)
        if known is not None and known.told_s >= mate.told_s:
            return False
        self._mates[mate.name] = mate
        return True

    def localized(self, now_s: float, timeout_s: float) -> list[Mate]:
        """Mates that spoke within the time-out and know where they are, by name."""
        self._mates = {name: mate for name, mate in self._mates.items() if now_s - mate.told_s <= timeout_s}
        return [mate for _, mate in sorted(self._mates.items()) if mate.localized]
