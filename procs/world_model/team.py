"""The newest message of each team mate about itself."""

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from lcmtypes.soccer import pass_agreement_t
from procs.model.frames import Floats
from procs.model.geometry import wrap_rad
from procs.model.robot import FASTEST_RAD_S
from procs.world_model.frame_pace import FramePace

_LEAST_M = 0.005  # deviation of a position that is added to the stated one
_ACCELERATION_M_S2 = 3.0  # deviation of a mate's acceleration since its message
_DRIFT_M_S = 0.5  # highest speed at which this acceleration moves a mate from the extrapolated place
_TURNING_S = 0.25  # messages further apart do not determine the turning speed
_EXTRAPOLATED_S = 0.5  # longest extrapolation of a velocity
_RADIO_S = 0.06  # a message may take this much longer than the one before
_STAMPS = 32  # number of messages of a mate whose times are known, so that none counts twice

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
    """Turning speed between its last two messages; 0 for one that no robot reaches."""
    overtaken: bool = False
    """Whether a newer message of it arrived earlier."""

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


@dataclass
class _Heard:
    """Messages that a mate has sent."""

    newest: Mate
    stamps_s: deque[float]
    """Times of the last messages, in the order of their arrival."""
    exposed_us: int = 0
    """Newest frame that it told."""
    frames: FramePace = field(default_factory=FramePace)
    """Pace of these frames."""


class Team:
    """The newest message of each mate, until the time-out."""

    def __init__(self) -> None:
        self._heard: dict[str, _Heard] = {}

    def note(self, mate: Mate) -> Mate | None:
        """Takes a mate's message; sets its turning speed and whether it was overtaken, and returns it.

        The radio may change the order of messages, and deliver one twice. A message that a newer one has overtaken
        changes no state of the mate. Returns None for a message that is known already.
        """
        heard = self._heard.get(mate.name)
        if heard is None:
            self._heard[mate.name] = _Heard(mate, deque((mate.told_s,), _STAMPS))
            return mate
        newest, stamps_s, passed_s = heard.newest, heard.stamps_s, mate.told_s - heard.newest.told_s
        mate.overtaken = passed_s < 0.0
        forgotten = mate.overtaken and len(stamps_s) == _STAMPS and mate.told_s < min(stamps_s)
        if forgotten or not passed_s or mate.told_s in stamps_s:  # many overtaken ones push the newest stamp out
            return None
        stamps_s.append(mate.told_s)
        if abs(passed_s) <= _TURNING_S and newest.localized and mate.localized:
            omega_rad_s = wrap_rad(mate.heading_rad - newest.heading_rad) / passed_s
            mate.omega_rad_s = omega_rad_s if abs(omega_rad_s) < FASTEST_RAD_S else 0.0  # it was corrected, not turned
        if not mate.overtaken:
            heard.newest = mate
        return mate

    def next_s(self, mate: Mate, exposed_us: int, period_s: float) -> float:
        """Returns the time after a mate's frame within which its next one arrives, unless a message is lost.

        Args:
            mate: the mate as its message tells.
            exposed_us: exposure of the frame in this message.
            period_s: time from one message to the next.
        """
        heard, next_s = self._heard.get(mate.name), 0.0
        if heard is not None:
            if exposed_us != heard.exposed_us and not mate.overtaken:
                heard.exposed_us = exposed_us
                heard.frames.note(exposed_us)
            next_s = heard.frames.next_s
        return max(next_s, period_s) + _RADIO_S

    def localized(self, now_s: float, timeout_s: float) -> list[Mate]:
        """Returns the mates, by name, that know their place and sent a message within the time-out."""
        self._heard = {name: heard for name, heard in self._heard.items() if now_s - heard.newest.told_s <= timeout_s}
        return [heard.newest for _, heard in sorted(self._heard.items()) if heard.newest.localized]
