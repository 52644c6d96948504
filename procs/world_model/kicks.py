"""Kicks that a robot knows: its own, which it has to tell its mates, and those of its mates."""

import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from lcmtypes.robot import kicker_state_t
from lcmtypes.soccer import team_message_t
from procs.model.frames import Floats
from procs.model.units import US_PER_S
from procs.world_model.own_view import OwnView
from procs.world_model.seen import Seen
from procs.world_model.team import Mate
from procs.world_model.told import mouth_of

_MESSAGES = 2  # number of messages that tell mates of a kick, because the radio may lose one
_KICKS = 8  # number of kicks of a mate whose times are known, so that none counts twice
_OLDEST_S = 0.5  # older kicks of mates are not used
_TIME_SHARE = 0.3  # of a tick: deviation of a kick's time, which lies somewhere in it; the root of 1/12 is 0.29


@dataclass(frozen=True)
class Kick:
    """Kick of the ball."""

    velocity_m_s: Floats
    """Velocity (2) that the ball got, world frame."""
    lift_m_s: float
    """Velocity upwards that the ball got."""
    age_s: float
    """Time since the kick."""
    time_sd_s: float
    """Deviation of that time."""
    mouth: Seen = Seen.NOTHING
    """Place of the ball at the kick (0 or 1), if a mate kicked it."""


@dataclass
class _Heard:
    """Kicks that a mate has told."""

    kicks: int
    """Number of its kicks in its newest message."""
    times_us: deque[int] = field(default_factory=lambda: deque(maxlen=_KICKS))
    """Times of the last kicks that were returned."""

    def takes(self, message: team_message_t, overtaken: bool) -> bool:
        """Takes a message; returns whether it tells a new kick.

        A message that a newer one has overtaken may tell an earlier kick than the newer one.
        """
        if overtaken:
            return 0 < message.kicks < self.kicks and message.kick_us not in self.times_us
        known, self.kicks = self.kicks, message.kicks
        return message.kicks > known


class Kicks:
    """Kicks of a robot and its mates; each kick is returned once."""

    def __init__(self, fastest_m_s: float) -> None:
        """Begins without a kick; no kick gives a ball a speed above `fastest_m_s`."""
        self.fastest_m_s = fastest_m_s
        self._own: int | None = None
        self._of_mates: dict[str, _Heard] = {}
        self._messages = 0

    @property
    def untold(self) -> bool:
        """Whether another message to the team has to tell of the newest own kick."""
        return self._messages > 0

    def note_message(self) -> None:
        """Notes that a message to the team tells of the newest own kick."""
        self._messages = max(0, self._messages - 1)

    def own(self, kicker: kicker_state_t, view: OwnView, mouth_m: float, passed_s: float) -> Kick | None:
        """Returns the robot's own new kick, if there is one, at the middle of the `passed_s` since the last tick.

        The first number of kicks counts kicks long ago, and a number that falls comes from a restarted driver; both
        report no new kick. Neither does a lost robot, which does not know in which direction it kicked.
        """
        known, self._own, lift_m_s = self._own, kicker.kicks, _lift_m_s(kicker)
        if (
            known is None
            or kicker.kicks <= known
            or not view.localized
            or not self._is_possible(kicker.kick_speed_m_s, lift_m_s)
        ):
            return None
        velocity_m_s = view.kicked_m_s(kicker.kick_speed_m_s, mouth_m)
        if not self._is_possible(*velocity_m_s.tolist(), lift_m_s):
            return None
        self._messages = _MESSAGES
        return Kick(velocity_m_s, lift_m_s, passed_s / 2, _TIME_SHARE * passed_s)

    def of_mates(
        self, told: Iterable[tuple[team_message_t, Mate]], now_us: int, mouth_m: float, tick_s: float
    ) -> list[Kick]:
        """Returns the new kicks in messages of mates that know their places.

        Args:
            told: messages with their senders.
            now_us: logical time.
            mouth_m: distance from a robot's middle to that of a held ball.
            tick_s: time from tick to tick of the mates.
        """
        found = []
        for message, mate in told:
            heard = self._of_mates.setdefault(mate.name, _Heard(message.kicks))
            is_new = heard.takes(message, mate.overtaken)
            age_s = (now_us - message.kick_us) / US_PER_S
            sound = self._is_possible(message.kick_vx_m_s, message.kick_vy_m_s, message.kick_vz_m_s)
            if is_new and mate.localized and sound and 0.0 <= age_s <= _OLDEST_S:
                heard.times_us.append(message.kick_us)
                mouth = mouth_of(mate, mouth_m, message.kick_us / US_PER_S)
                velocity_m_s = np.array((message.kick_vx_m_s, message.kick_vy_m_s))
                found.append(Kick(velocity_m_s, message.kick_vz_m_s, age_s, _TIME_SHARE * tick_s, mouth))
        return found

    def _is_possible(self, *velocity_m_s: float) -> bool:
        """Returns whether a kick can give a ball such a velocity."""
        return math.hypot(*velocity_m_s) <= self.fastest_m_s


def _lift_m_s(kicker: kicker_state_t) -> float:
    """Returns the velocity upwards that the newest kick gave to the ball; 0 if the hardware tells no elevation."""
    elevation_rad = kicker.kick_elevation_rad
    return kicker.kick_speed_m_s * math.tan(elevation_rad) if 0.0 < elevation_rad < math.pi / 2 else 0.0
