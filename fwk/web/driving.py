"""Driving by hand: a pad for keys, mouse and fingers, and the messages that it writes."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from nicegui.element import Element

from fwk.clock import US_PER_S, monotonic_us
from fwk.web.instruments import JOYSTICK, MOTION

SILENCE_S = 0.5
"""A held pad without a message for this time has lost its browser: its robot is stopped."""
BUTTONS = 10


@dataclass(frozen=True)
class Deflection:
    """Deflection of the pad, each part from -1 to 1: forward, left, turn counter-clockwise."""

    forward: float = 0.0
    left: float = 0.0
    turn: float = 0.0
    buttons: frozenset[int] = frozenset()
    held: bool = False

    @classmethod
    def of(cls, told: Mapping[str, Any]) -> "Deflection":
        """Makes a deflection of the values from a browser; each part is limited to -1 .. 1."""
        forward, left, turn = (max(-1.0, min(1.0, float(part))) for part in told["at"])
        return cls(forward, left, turn, frozenset(map(int, told["buttons"])), bool(told["held"]))


def drives(members: set[str]) -> bool:
    """Tells whether messages with these members drive something: a joystick, or a wanted motion."""
    return JOYSTICK.members <= members or (MOTION.members <= members and not {"x_m", "y_m"} & members)


def members_of(members: set[str], stick: Deflection, speed_m_s: float, turn_rad_s: float) -> dict[str, Any]:
    """Returns the members of the message for a deflection.

    Axes of a joystick: right, forward, turn clockwise.
    """
    if JOYSTICK.members <= members:
        buttons = [number in stick.buttons for number in range(BUTTONS)]
        return {"axes": [0.0 - stick.left, stick.forward, 0.0 - stick.turn], "buttons": buttons}  # never -0.0
    made: dict[str, Any] = {
        "vx_m_s": stick.forward * speed_m_s,
        "vy_m_s": stick.left * speed_m_s,
        "omega_rad_s": stick.turn * turn_rad_s,
    }
    return {**made, "enabled": stick.held} if "enabled" in members else made


class Watchman:
    """Lets go of a pad whose browser has fallen silent."""

    def __init__(self, now_us: Callable[[], int] = monotonic_us) -> None:
        self._now_us = now_us
        self._held = False
        self._told_us = 0

    def told(self, stick: Deflection) -> None:
        """Notes that the browser has told a deflection."""
        self._held, self._told_us = stick.held, self._now_us()

    def lets_go(self) -> bool:
        """Returns true once if the pad is held and its browser says nothing any more."""
        lost = self._held and self._now_us() > self._told_us + SILENCE_S * US_PER_S
        if lost:
            self._held = False
        return lost


class Stick(Element, component="stick.js"):
    """The pad."""

    def __init__(self, label: str) -> None:
        super().__init__()
        self._props["label"] = label

    def on_stick(self, take: Callable[[Deflection], Any]) -> None:
        """Calls a function with each deflection that the browser tells."""
        self.on("stick", lambda event: take(Deflection.of(event.args)))
