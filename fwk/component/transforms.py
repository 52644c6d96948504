"""The transforms aspect: poses of frames of reference in each other, now and in the last seconds."""

import numpy as np

from fwk.component.aspect import Aspect
from fwk.component.channels import Reads
from fwk.component.log import Logger
from fwk.component.transform_tree import Transform, TransformError, TransformTree
from lcmtypes.core import transform_t, transforms_t


class Transforms(Aspect):
    """Tree of frames, provided by the component that writes it: `self.tf.lookup("world", "base").apply(points_m)`.

    It holds the transforms of the last ten seconds that are visible to the iteration. A transform that does not fit
    into the tree is left out and counted in `refused`, and the log names the 1st, 10th, 100th.
    """

    log: Logger
    transforms: Reads[transforms_t]

    def init(self) -> None:
        self.tree = TransformTree()
        self.refused = 0

    def begin(self) -> None:
        for message in self.transforms.fresh:
            for each in message.transforms:
                try:
                    self.tree.put(each.parent, each.child, each.time_us, transform_of(each), fixed=each.fixed)
                except TransformError as error:
                    self._refuse(error)

    def _refuse(self, error: TransformError) -> None:
        self.refused += 1
        if str(self.refused).strip("0") == "1":
            self.log.warning(f"{self.transforms.channel}: {error} ({self.refused} transforms refused so far)")

    @property
    def frames(self) -> list[str]:
        """Names of all frames, in alphabetical order."""
        return self.tree.frames

    def lookup(self, target: str, source: str, time_us: int | None = None) -> Transform:
        """Returns the transform from coordinates of the source frame to the target frame.

        Args:
            target: Name of the frame of the result.
            source: Name of the frame of the given points.
            time_us: Logical time; by default the newest at which all frames between the two are known.

        Raises:
            UnknownFrameError: a frame does not exist, or not yet.
            DisconnectedError: the two frames have no common ancestor.
            ExtrapolationError: a frame between the two is not known at that time.
        """
        return self.tree.lookup(target, source, time_us)


def transform_of(message: transform_t) -> Transform:
    """Returns the transform of a message."""
    return Transform(
        np.array([message.x_m, message.y_m, message.z_m]),
        np.array([message.qw, message.qx, message.qy, message.qz]),
    )


def transform_message(
    parent: str, child: str, time_us: int, transform: Transform, *, fixed: bool = False
) -> transform_t:
    """Returns the message of a transform, to be written in a `transforms_t`."""
    made = transform_t()
    made.parent, made.child, made.time_us, made.fixed = parent, child, time_us, fixed
    made.x_m, made.y_m, made.z_m = map(float, transform.translation_m)
    made.qw, made.qx, made.qy, made.qz = map(float, transform.rotation)
    return made
