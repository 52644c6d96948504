"""Small components for launch files under test."""

from typing import Annotated, Literal

from pydantic import Field as Setting

from fwk import Alike, Aspect, Component, Config, Each, Image, Reads, TimeSource, VisionMaster, Writes, channel
from lcmtypes.core import frame_t
from lcmtypes.robot import motor_command_t, odometry_t


class Limits(Config):
    speed_m_s: float = 2.0
    """Fastest."""
    turns: tuple[float, float] = (-1.0, 1.0)
    """Least and greatest."""


class WheelsConfig(Config):
    gain: float = Setting(0.5, ge=0.0, le=1.0)
    """Of the loop."""
    count: int = 3
    """Of wheels."""
    brake: bool = True
    """On when idle."""
    mode: Literal["soft", "hard"] = "soft"
    """Of braking."""
    label: str = ""
    """For people."""
    limits: Limits = Limits()
    """Permitted actions."""


class Wheels(Component):
    """Drives by `motor_command`, publishes `odometry`."""

    stage = ("sensor_acquire", "act_exec")
    config: WheelsConfig
    motor_command: Reads[motor_command_t]
    odometry: Writes[odometry_t]


class Pilot(Component):
    """The other side of Wheels."""

    stage = "act"
    odometry: Reads[odometry_t]
    motor_command: Writes[motor_command_t]


class KeyedConfig(Config):
    key: str
    """Has no default."""


class Keyed(Component):
    """Has a setting without a default."""

    stage = "act"
    config: KeyedConfig


class PlaceConfig(Config):
    bed: Annotated[Limits, Alike] = Limits()
    """Measures that all know."""
    names: Annotated[dict[str, int], Alike] = {"fern": 1}
    """Numbers of plants."""
    gain: float = 0.5
    """A setting in which gardeners may differ."""


class Gardener(Component):
    """Works in the bed of all others."""

    stage = "act"
    config: PlaceConfig


class Odometer(Component):
    """Writes odometry, reads nothing."""

    stage = "sensor_acquire"
    odometry: Writes[odometry_t]


class Watcher(Component):
    """Reads every odometry."""

    stage = "post_loop"
    odometries: Each[Reads[odometry_t]] = channel("*/odometry")


class Feeder(Component):
    """Writes the odometry of all components that read one."""

    stage = "pre_loop"
    feeds: Each[Writes[odometry_t]] = channel("*/odometry")


class Reader(Component):
    """Reads one odometry."""

    stage = "think"
    odometry: Reads[odometry_t]


class Mistaken(Component):
    """Reads `odometry` as another type."""

    stage = "think"
    odometry: Reads[motor_command_t]


class Camera(Component):
    """Gives out frames."""

    stage = "sensor_acquire"
    image: VisionMaster


class Eye(Component):
    """Looks at frames."""

    stage = "sensor_prepare"
    image: Image


class MirrorConfig(Config):
    height_m: float = 0.75
    """Above the ground."""
    size_px: tuple[int, int] = (400, 400)
    """Of the frames."""


class MirroredConfig(Config):
    mirror: MirrorConfig = MirrorConfig()
    """Settings of the camera."""
    gain: float = 1.0
    """Of its own."""


class MirroredCamera(Camera):
    """Gives out frames of a mirror."""

    config: MirroredConfig


class MirroredEye(Eye):
    """Looks at frames of a mirror."""

    config: MirroredConfig


class Announcer(Component):
    """Writes messages like a camera's announcements, without frames."""

    stage = "sensor_acquire"
    image: Writes[frame_t]


class Sun(Component):
    """Time source."""

    stage = "pre_loop"
    time_source: TimeSource


class Way(Aspect):
    """Aspect: the distance covered."""

    odometry: Reads[odometry_t]


class Wayfarer(Component):
    """Provides the distance that it measured."""

    stage = "sensor_acquire"
    provides = Way
    odometry: Writes[odometry_t]


class Guide(Component):
    """Uses the aspect `Way`."""

    stage = "think"
    way: Way


class Lead(Aspect):
    """Aspect of a leader."""


class Leader(Component):
    """Provides `Lead`, and uses `Way`."""

    stage = "think"
    provides = Lead
    way: Way


class Led(Wayfarer):
    """Provides `Way`, and uses `Lead`."""

    lead: Lead


class Stageless(Component):
    """Declares no stage."""


class NotAComponent:
    """A class that is not a component."""


CHANNELS = ("*/odometry",)


def greet() -> str:
    """A function."""
    return "hello"


answer = 42
