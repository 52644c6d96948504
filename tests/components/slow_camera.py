"""A camera that takes a while to become ready."""

from pathlib import Path

from fwk.clock import sleep_s
from small import Camera


class SlowCamera(Camera):
    """Becomes ready as soon as the file `go` exists."""

    def init(self) -> None:
        while not Path("go").exists():
            sleep_s(0.01)
