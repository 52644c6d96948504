"""A counter that writes when it ends."""

from small import Counter


class LastWords(Counter):
    """Counts up and writes -1 rad at the end."""

    def finalize(self) -> None:
        self.imu.value.heading_rad = -1.0
        self.imu.write()
        super().finalize()
