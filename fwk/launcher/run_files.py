"""Watches the files of a run for deletion."""

from collections.abc import Callable
from pathlib import Path

from fwk.clock import US_PER_S, monotonic_us
from fwk.lcm.log_parts import exists
from fwk.supervisor.options import RunOptions


class RunFiles:
    """Sink of the gateway that checks the run directory and the recording once a second.

    Args:
        options: names the run directory and the recording, both of which exist.
        report: takes the name of the deleted file, once.
    """

    def __init__(self, options: RunOptions, report: Callable[[str], None]) -> None:
        self.deleted = ""
        """The deleted one, as text; empty: both exist."""
        paths = {"run directory": options.run_dir, "recording": options.record}
        self._watched = {what: (path, path.stat().st_ino) for what, path in paths.items() if path and path.exists()}
        self._report = report
        self._look_us = 0

    def message(self, _channel: str, _data: bytes, _time_us: int) -> None:
        """Checks the files when it is time, also while no tick ends."""
        now_us = monotonic_us()
        if now_us >= self._look_us:
            self._look_us = now_us + US_PER_S
            self._look()

    def tick(self) -> None:
        """Does nothing."""

    def close(self) -> None:
        """Checks the files a last time."""
        self._look()

    def _look(self) -> None:
        for what, (path, inode) in self._watched.items() if not self.deleted else ():
            if _is_gone(path, inode):
                self.deleted = f"the {what} {path} was deleted during the run"
                self._report(f"{self.deleted}; files written there are lost")
                return


def _is_gone(path: Path, inode: int) -> bool:
    try:
        return path.stat().st_ino != inode  # another file has taken its place
    except FileNotFoundError:
        return not exists(path)  # a recording may have been compressed
    except OSError:  # it cannot be seen from here, for example for lack of rights
        return False
