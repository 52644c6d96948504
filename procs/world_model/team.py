"""The newest message of each team mate about itself."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from lcmtypes.soccer import pass_agreement_t
from procs.model.frames import Floats
from procs.model.geometry import wrap_rad
from procs.world_model.frame_pace import FramePace

_LEAST_M = 0.005  # deviation of a position that is added to the stated one
_ACCELERATION_M_S2 = 3.0  # deviation of a mate's acceleration since its message
_DRIFT_M_S = 0.5  # highest speed at which this acceleration moves a mate from the extrapolated place
_TURNING_S = 0.25  # messages further apart do not determine the turning speed
_EXTRAPOLATED_S = 0.5  # longest extrapolation of a velocity
_RADIO_S = 0.06  # a message may take this much longer than the one before

PlaceRow = tuple[float, float, float, float, float, float, float, float]
"""Position x, y (m), velocity vx, vy (m/s), and covariance xx, xy, yx, yy (m²) of the position."""


def _least_m2() -> Floats:
    return np.eye(2) * _LEAST_M**2


@dataclass
class Mate:
    """A team mate as it was at `told_s`, world frame."""

    name: str
    role: str
    told_s: float
    position_m: Floats
    heading_rad: float
    velocity_m_s: Floats
    localized: bool
    covariance_m2: Floats = field(default_factory=_least_m2)
    """(2, 2) of the position at `told_s`, as the mate stated it."""
    number: int = 0
    """Number on the mate's back; 0 if it is not stated."""
    holds_ball: bool = False
    """Whether the ball was in its mouth at `told_s`."""
    agreement: pass_agreement_t = field(default_factory=pass_agreement_t)
    """Its agreement about a pass."""
    omega_rad_s: float = 0.0
    """Turning speed between its last two messages."""

    def position_at(self, time_s: float) -> Floats:
        """Returns the probable position (2) at a time near `told_s`."""
        passed_s = min(_EXTRAPOLATED_S, max(-_EXTRAPOLATED_S, time_s - self.told_s))
        return self.position_m + self.velocity_m_s * passed_s


class Places:
    """Positions of k mates at times near their messages.

    It computes with plain numbers, because NumPy's overhead exceeds the arithmetic for so few robots.
    """

    def __init__(self, mates: Sequence[Mate]) -> None:
        self._mates = [
            (mate.told_s, *mate.position_m.tolist(), *mate.velocity_m_s.tolist(), *mate.covariance_m2.ravel().tolist())
            for mate in mates
        ]

    def first(self, count: int) -> "Places":
        """Returns the places of the first mates."""
        if count == len(self._mates):
            return self
        made = Places(())
        made._mates = self._mates[:count]
        return made

    def rows_at(self, time_s: float, drifts_s: float = math.inf) -> list[PlaceRow]:
        """Returns k probable positions with velocities and covariances.

        The covariances grow with the time since the message, but for `drifts_s` at most.
        """
        rows = []
        for told_s, x_m, y_m, vx_m_s, vy_m_s, xx_m2, xy_m2, yx_m2, yy_m2 in self._mates:
            passed_s = time_s - told_s
            extrapolated_s = min(_EXTRAPOLATED_S, max(-_EXTRAPOLATED_S, passed_s))
            drifted_s = min(drifts_s, abs(passed_s))
            drift_m = min(_ACCELERATION_M_S2 / 2 * drifted_s, _DRIFT_M_S) * drifted_s
            drift_m2 = _LEAST_M**2 + drift_m * drift_m
            x_m, y_m = x_m + vx_m_s * extrapolated_s, y_m + vy_m_s * extrapolated_s
            rows.append((x_m, y_m, vx_m_s, vy_m_s, xx_m2 + drift_m2, xy_m2, yx_m2, yy_m2 + drift_m2))
        return rows

    def at(self, time_s: float, drifts_s: float = math.inf) -> tuple[Floats, Floats]:
        """Returns the same as arrays: positions (k, 2) and covariances (k, 2, 2)."""
        rows = np.array(self.rows_at(time_s, drifts_s)).reshape(-1, 8)
        return rows[:, :2], rows[:, 4:].reshape(-1, 2, 2)


class Team:
    """The newest message of each mate, until the time-out."""

    def __init__(self) -> None:
        self._mates: dict[str, Mate] = {}
        self._frames: dict[str, tuple[int, FramePace]] = {}  # newest exposure that each mate told, and their pace

    def note(self, mate: Mate) -> Mate | None:
        """Takes a mate's message; sets and returns the mate with its turning speed.

        Returns None if a newer message is known already, because the radio may change the order of messages.
        """
        known = self._mates.get(mate.name)
        if known is not None:
            passed_s = mate.told_s - known.told_s
            if passed_s <= 0.0:
                return None
            if passed_s <= _TURNING_S and known.localized and mate.localized:
                mate.omega_rad_s = wrap_rad(mate.heading_rad - known.heading_rad) / passed_s
        self._mates[mate.name] = mate
        return mate

    def next_s(self, mate: str, exposed_us: int, period_s: float) -> float:
        """Returns the time after a mate's frame within which its next one arrives, unless a message is lost.

        Args:
            mate: name of the mate.
            exposed_us: exposure of the frame that its newest message told.
            period_s: time from one message to the next.
        """
        told_us, pace = self._frames.get(mate) or (0, FramePace())
        if exposed_us != told_us:
            pace.note(exposed_us)
            self._frames[mate] = exposed_us, pace
        return max(pace.next_s, period_s) + _RADIO_S

    def localized(self, now_s: float, timeout_s: float) -> list[Mate]:
        """Returns the mates, by name, that know their place and sent a message within the time-out."""
        self._mates = {name: mate for name, mate in self._mates.items() if now_s - mate.told_s <= timeout_s}
        if len(self._frames) > len(self._mates):
            self._frames = {name: told for name, told in self._frames.items() if name in self._mates}
        return [mate for _, mate in sorted(self._mates.items()) if mate.localized]
