"""The transforms aspect: where frames of reference stand in each other, now and a while ago."""

import numpy as np

from fwk.component.aspect import Aspect
from fwk.component.channels import Reads
from fwk.component.transform_tree import Transform, TransformTree
from lcmtypes.core import transform_t, transforms_t


class Transforms(Aspect):
    """`self.tf.lookup("world", "base").apply(points_m)`; provided by whoever writes the tree.

    What it knows is what became visible up to this iteration, of the last ten seconds.
    """

    transforms: Reads[transforms_t]

    def init(self) -> None:
        self.tree = TransformTree()

    def begin(self) -> None:
        for message in self.transforms.fresh:
            for each in message.transforms:
                self.tree.put(each.parent, each.child, each.time_us, transform_of(each), fixed=each.fixed)

    @property
    def frames(self) -> list[str]:
        """All names, in alphabetical order."""
        return self.tree.frames

    def lookup(self, target: str, source: str, time_us: int | None = None) -> Transform:
        """Takes coordinates of the source frame to the target frame, at a logical time or the newest that is known.

        Raises:
            UnknownFrameError: there is no such frame, or none yet.
            DisconnectedError: no way leads from one to the other.
            ExtrapolationError: a frame on the way is not known for that time.
        """
        return self.tree.lookup(target, source, time_us)


def transform_of(message: transform_t) -> Transform:
    """As it is calculated with."""
    return Transform(
        np.array([message.x_m, message.y_m, message.z_m]),
        np.array([message.qw, message.qx, message.qy, message.qz]),
    )


def transform_message(
    parent: str, child: str, time_us: int, transform: Transform, *, fixed: bool = False
) -> transform_t:
    """As it is sent."""
    made = transform_t()
    made.parent, made.child, made.time_us, made.fixed = parent, child, time_us, fixed
    made.x_m, made.y_m, made.z_m = map(float, transform.translation_m)
    made.qw, made.qx, made.qy, made.qz = map(float, transform.rotation)
    return made
