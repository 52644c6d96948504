"""Conditions that hold after every fault: the run leaves nothing behind, and its recording says what happened."""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

import psutil

from tests.harness.logs import Recording, difference
from tests.harness.runs import Launched, replayed

GONE_S = 2.0
_SHARED = ("/memfd:", "/dev/shm/")


class Aftermath:
    """Shared memory and process groups of a run, noted while it runs."""

    def __init__(self) -> None:
        self._memory: set[tuple[int, int]] = set()
        self._sessions: set[int] = set()

    def note(self, run: Launched) -> None:
        """Notes what the run holds now."""
        for process in run.processes():
            with contextlib.suppress(OSError):
                self._sessions.add(os.getsid(process.pid))
                self._memory |= {place for place, _ in _shared_memory(process.pid)}
        assert self._memory, "the run has frames in shared memory"

    def check(
        self,
        run: Launched,
        *,
        code: int | None = 0,
        equal_to: Path | None = None,
        replays: bool = True,
        tracebacks: bool = False,
        gone_s: float = GONE_S,
    ) -> Recording:
        """Asserts that the run ended with `code`, left nothing behind, and wrote a whole recording.

        `equal_to` is the log of an undisturbed run; with `replays` a replay has to write the same messages.
        """
        if code is not None:
            assert run.wait() == code, run.text
        assert run.gone_within(gone_s), run.processes()
        assert self._left() == []
        if code is not None:
            assert tracebacks or "Traceback" not in run.text, run.text
        log = run.folder / "log.lcm"
        recording = Recording(log)
        assert recording.records
        if equal_to:
            assert difference(equal_to, log) == ""
        if replays:
            replayed(run.folder, log=log)
        return recording

    def _left(self) -> list[str]:
        """Returns the processes that still hold the run's shared memory or belong to one of its sessions."""
        found = []
        for process in psutil.process_iter():
            with contextlib.suppress(OSError, psutil.Error):
                if process.status() == psutil.STATUS_ZOMBIE:
                    continue
                if os.getsid(process.pid) in self._sessions:
                    found.append(f"{process} is of the run's session")
                held = [name for place, name in _shared_memory(process.pid) if place in self._memory]
                found += [f"{process} holds {name}" for name in held]
        return found


def _shared_memory(pid: int) -> Iterator[tuple[tuple[int, int], str]]:
    """Returns device and inode of each shared-memory object that a process holds, with its name."""
    for descriptor in Path(f"/proc/{pid}/fd").iterdir():
        with contextlib.suppress(OSError):
            name = os.readlink(descriptor)
            if name.startswith(_SHARED):
                status = descriptor.stat()
                yield (status.st_dev, status.st_ino), name
