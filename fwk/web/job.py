"""Commands of fwk that a page starts as child processes, with their output."""

import asyncio
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from fwk.clock import US_PER_S, monotonic_us
from fwk.model.parent_death import die_with_parent

_BIN = Path(sys.executable).parent
_CHUNK_BYTES = 1 << 16
_STARTER = ThreadPoolExecutor(1, "commands")
"""Starts all commands; a command inherits the priority of the thread that starts it."""


def keep_priority() -> None:
    """Lets commands run with the present priority of this thread, also if the console lowers its own later."""
    _STARTER.submit(int).result()  # creates the thread


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
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def age_s(self) -> float:
        """Time since its start."""
        return (monotonic_us() - self._began_us) / US_PER_S

    async def run(self) -> int:
        """Runs the command to its end; returns the exit code."""
        loop = asyncio.get_running_loop()
        self._process = process = await loop.run_in_executor(_STARTER, _started, self.words)
        output = asyncio.StreamReader()
        pipe, _ = await loop.connect_read_pipe(lambda: asyncio.StreamReaderProtocol(output), process.stdout)
        try:
            while data := await output.read(_CHUNK_BYTES):
                self._take(data.decode(errors="replace"))
        finally:
            pipe.close()
        self.code = await asyncio.to_thread(process.wait)
        return self.code

    def end(self) -> None:
        """Ends the command as Ctrl-C does."""
        if self._process:
            self._process.send_signal(signal.SIGINT)


def _started(words: Sequence[str]) -> subprocess.Popen[bytes]:
    parent = os.getpid()
    return subprocess.Popen(
        [str(_BIN / words[0]), *words[1:]],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        env={**os.environ, "NO_COLOR": "1", "TERM": "dumb", "PYTHONUNBUFFERED": "1"},
        start_new_session=True,  # the session of the console has the lowest priority
        preexec_fn=lambda: _prepare(parent),
    )


def _prepare(parent: int) -> None:
    """Lets a child end with its parent, and by SIGINT also if the console was started in the background of a script."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    die_with_parent(parent, signal.SIGTERM)
