"""Tree of a robot's frames: its pose in the world, and the parts mounted on it."""

from pydantic import Field, ValidationInfo, field_validator

from fwk import (
    Component,
    Config,
    Reads,
    Transform,
    TransformError,
    Transforms,
    TransformTree,
    Writes,
    channel,
    transform_message,
)
from lcmtypes.core import transforms_t
from lcmtypes.soccer import pose_t
from procs.model.geometry import plausible
from procs.model.robot import ROBOT, RobotModel
from procs.vision.calibration import MirrorConfig


class Mounting(Config):
    """Place of a part; turned about the x axis of its parent, then y, then z."""

    parent: str = "base"
    """Frame on which the part is mounted."""
    x_m: float = 0.0
    """Distance forward from the parent's origin."""
    y_m: float = 0.0
    """Distance to the left from the parent's origin."""
    z_m: float = 0.0
    """Height above the parent's origin."""
    roll_rad: float = 0.0
    """Angle about the parent's x axis."""
    pitch_rad: float = 0.0
    """Angle about the parent's y axis."""
    yaw_rad: float = 0.0
    """Angle about the parent's z axis."""

    @property
    def transform(self) -> Transform:
        """Transform from the frame of the part to that of its parent."""
        shift_m = (self.x_m, self.y_m, self.z_m)
        return Transform.of_angles(shift_m, self.roll_rad, self.pitch_rad, self.yaw_rad)


class FrameTreeConfig(Config):
    """Settings of the tree."""

    world: str = Field("world", frozen=True)
    """Frame of the field: origin in its centre."""
    base: str = Field("base", frozen=True)
    """Frame of the robot: on the ground below its centre, x forward, y left."""
    mirror: MirrorConfig = Field(MirrorConfig(), frozen=True)
    """Calibration of the camera, whose viewpoint is the frame `camera`."""
    robot: RobotModel = Field(ROBOT, frozen=True)
    """Geometry of the robot; the middle of its mouth is the frame `kicker`."""
    mounted: dict[str, Mounting] = Field({}, frozen=True)
    """Further frames that do not move on the robot; an entry `camera` or `kicker` replaces the usual place."""

    @field_validator("mounted")
    @classmethod
    def _is_tree(cls, mounted: dict[str, Mounting], info: ValidationInfo) -> dict[str, Mounting]:
        """Refuses cycles, frames with two parents, and parents that do not exist; names have been checked before."""
        if not {"world", "base"} <= info.data.keys():
            return mounted
        world, base = info.data["world"], info.data["base"]
        every = dict.fromkeys(("camera", "kicker"), Mounting(parent=base)) | mounted
        tree = TransformTree()
        try:
            tree.put(world, base, 0, Transform.of((0.0, 0.0, 0.0)))
            for name, mounting in every.items():
                tree.put(mounting.parent, name, 0, mounting.transform, fixed=True)
        except TransformError as error:
            raise ValueError(str(error)) from error
        known = {world, base, *every}
        for name, mounting in every.items():
            if mounting.parent not in known:
                frames = ", ".join(sorted(known - {name}))
                raise ValueError(f"frame '{name}' has the parent '{mounting.parent}'; there are {frames}")
        return mounted

    @property
    def mountings(self) -> dict[str, Mounting]:
        """All frames that do not move on the robot."""
        camera = Mounting(parent=self.base, z_m=self.mirror.height_m)
        kicker = Mounting(parent=self.base, x_m=self.robot.mouth_m)
        return {"camera": camera, "kicker": kicker} | self.mounted


class FrameTree(Component):
    """Publishes the robot's frames, and provides `Transforms` to its components."""

    stage = "worldstate"
    provides = Transforms
    config: FrameTreeConfig
    pose: Reads[pose_t]
    transforms: Writes[transforms_t] = channel("transforms")

    def init(self) -> None:
        self._mounted = [
            transform_message(mounting.parent, name, 0, mounting.transform, fixed=True)
            for name, mounting in self.config.mountings.items()
        ]

    def loop(self) -> None:
        pose, config = self.pose, self.config
        told = list(self._mounted)
        value = pose.value
        if pose.has_value and value.localized and plausible(value.x_m, value.y_m, value.heading_rad):
            stands = Transform.of((value.x_m, value.y_m, 0.0), value.heading_rad)
            told.append(transform_message(config.world, config.base, pose.header.time_us, stands))
        self.transforms.value.transforms, self.transforms.value.n = told, len(told)
        self.transforms.write()
