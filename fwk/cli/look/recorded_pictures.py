"""Pictures of a recording, for `fwk cam`."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from fwk.cli.look import picture_output
from fwk.cli.look.picture_output import Pixels, fail
from fwk.clock import US_PER_S
from fwk.model.errors import hint
from fwk.model.plan import NOBODY
from fwk.program import BAD_INPUT
from fwk.recording.pictures import RecordedPicture, pictures_in
from fwk.recording.replay.recording import Recording, RecordingError


class Recorded:
    """Pictures of a log, up to a tick if one is given; of a camera whose frames were recorded, the frames alone."""

    def __init__(self, log: Path, tick: int | None) -> None:
        self._log = log
        self._tick = tick
        self._counts: dict[str, int] = {}
        self._last: dict[str, RecordedPicture] = {}
        for picture in self._upto():
            last = self._last.get(picture.camera)
            if last is None or picture.is_frame >= last.is_frame:
                former = self._counts[picture.camera] if last and picture.is_frame == last.is_frame else 0
                self._counts[picture.camera] = former + 1
                self._last[picture.camera] = picture
        if not self._counts:
            upto = f" up to tick {tick}" if tick else ""
            how = "'record: {frames: ...}' in the launch file, or a component that compresses pictures, records some"
            fail(f"{log}: no pictures{upto}; {how}")

    def rows(self) -> list[dict[str, Any]]:
        """Returns each camera with its number of pictures, for programs."""
        found = sorted(self._last.items())
        return [
            {"channel": camera, "pictures": self._counts[camera], "format": last.format, "tick": last.tick}
            for camera, last in found
        ]

    def lines(self) -> list[str]:
        """Returns the same as lines of text."""
        return [
            f"{row['channel']:20} {row['pictures']} pictures ({row['format']}), the last of tick {row['tick']}"
            for row in self.rows()
        ]

    def newest(self, name: str) -> tuple[Pixels, str]:
        """Returns the last picture of a camera, and its channel, frame, tick and time."""
        picture = self._last[self._camera(name)]
        where = f"{picture.camera}, frame {picture.frame}, tick {picture.tick}, {picture.time_us / US_PER_S:.3f} s"
        return self._decoded(picture), where

    def save_all(self, name: str, folder: Path) -> int:
        """Writes all pictures of a camera as numbered png files; returns their number."""
        camera = self._camera(name)
        for picture in self._upto():
            if picture.camera == camera and picture.is_frame == self._last[camera].is_frame:
                picture_output.save(self._decoded(picture), folder / f"frame{picture.frame:06}.png")
        return self._counts[camera]

    def _upto(self) -> Iterator[RecordedPicture]:
        return (each for each in pictures_in(self._log) if self._tick is None or each.tick <= self._tick)

    def _camera(self, name: str) -> str:
        """Returns the channel of that name, or of the camera component of that name."""
        camera = self._written_by().get(name, name)
        if camera not in self._last:
            fail(f"{self._log}: no pictures of '{name}'; {hint(name, self._last)}", BAD_INPUT)
        return camera

    def _written_by(self) -> dict[str, str]:
        """Returns camera components with their channels, if the recording contains its plan."""
        try:
            plan = Recording(self._log).plan
        except RecordingError:
            return {}
        cameras = [each for each in plan.channels if each.images and each.writer != NOBODY]
        return {plan.components[each.writer].name: each.name for each in cameras}

    def _decoded(self, picture: RecordedPicture) -> Pixels:
        pixels = picture.pixels()
        if pixels is None:
            fail(f"{self._log}: frame {picture.frame} of {picture.camera} is damaged")
        return pixels
