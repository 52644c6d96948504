"""Where components of a replay find camera frames: what was lost to them in the run is lost again."""

from collections.abc import Collection

from fwk.aspects.vision import Frame, Frames


class Withheld:
    """Frames of one camera for one start of a component, without those that it did not get."""

    def __init__(self, frames: Frames, missed: Collection[int]) -> None:
        self._frames = frames
        self._missed = missed

    def get(self, number: int, size: int) -> Frame | None:
        """As of a ring."""
        return None if number in self._missed else self._frames.get(number, size)
