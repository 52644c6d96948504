"""Commands of fwk that a page starts as child processes, with their output."""

import asyncio
import os
import signal
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from fwk.clock import US_PER_S, monotonic_us
from fwk.model.parent_death import die_with_parent

_BIN = Path(sys.executable).parent
_CHUNK_BYTES = 1 << 16


class Job:
    """A command that runs beside the console; it ends with the console.

    Args:
        words: the command, such as `fwk`, and its arguments.
        take: gets the output, piece by piece.
    """

    def __init__(self, words: Sequence[str], take: Callable[[str], None]) -> None:
        self.words = list(words)
        self.code: int | None = None
        """Exit code; None while it runs."""
        self._take = take
        self._began_us = monotonic_us()
        self._process: asyncio.subprocess.Process | None = None

    @property
    def age_s(self) -> float:
        """Time since its start."""
        return (monotonic_us() - self._began_us) / US_PER_S

    async def run(self) -> int:
        """Runs the command to its end; returns the exit code."""
        parent = os.getpid()
        self._process = await asyncio.create_subprocess_exec(
            str(_BIN / self.words[0]),
            *self.words[1:],
            stdin=asyncio.subprocess.DEVNULL,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.STDOUT,
            env={**os.environ, "NO_COLOR": "1", "TERM": "dumb", "PYTHONUNBUFFERED": "1"},
            preexec_fn=lambda: _prepare(parent),
        )
        assert self._process.stdout is not None
        while data := await self._process.stdout.read(_CHUNK_BYTES):
            self._take(data.decode(errors="replace"))
        self.code = await self._process.wait()
        return self.code

    def end(self) -> None:
        """Ends the command as Ctrl-C does."""
        if self._process and self._process.returncode is None:
            self._process.send_signal(signal.SIGINT)


def _prepare(parent: int) -> None:
    """Lets a child end with its parent, and by SIGINT also if the console was started in the background of a script."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    die_with_parent(parent, signal.SIGTERM)
