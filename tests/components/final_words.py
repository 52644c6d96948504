"""A counter that writes in `finalize`."""

from small import Counter


class LastWords(Counter):
    """Counts up and writes -1 rad in `finalize`."""

    def finalize(self) -> None:
        self.imu.value.heading_rad = -1.0
        self.imu.write()
        super().finalize()
