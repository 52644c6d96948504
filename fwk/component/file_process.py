"""A program that is started for each iteration, reads a file and writes a file."""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from fwk.component.child_process import ANSWER_BYTES_MAX, ProgramError, find_words
from fwk.model.parent_death import die_with_parent

INPUT, OUTPUT = "input.json", "output.json"


class FileProcess:
    """Starts a program for each request, in a folder of its own in which the two files are.

    The folder stays until the end, so that the program finds there what it has left. Its standard streams are those of
    this process, its output goes to the log.
    """

    def __init__(self, command: Sequence[str]) -> None:
        self.command = " ".join(command)
        self._words = find_words(command)
        self._folder = Path(tempfile.mkdtemp(prefix="fwk-program-"))

    def exchange(self, request: bytes, _length_of: Callable[[bytearray, int], int], timeout_s: float | None) -> bytes:
        """Writes the request to the input file, runs the program, and returns its output file.

        Args:
            request: content of the input file.
            timeout_s: wall time after which the program has failed; None: no limit.

        Raises:
            ProgramError: the program cannot be started, fails, writes no file or too much, or is not done in time.
        """
        try:
            return self._exchange(request, timeout_s)
        except BaseException:
            self.kill()
            raise

    def close(self) -> None:
        """Removes the folder."""
        shutil.rmtree(self._folder, ignore_errors=True)

    def kill(self) -> None:
        """Removes the folder, too: no program runs between two requests."""
        self.close()

    def _exchange(self, request: bytes, timeout_s: float | None) -> bytes:
        output = self._folder / OUTPUT
        output.unlink(missing_ok=True)
        (self._folder / INPUT).write_bytes(request)
        try:
            done = subprocess.run(
                self._words,
                cwd=self._folder,
                stdin=subprocess.DEVNULL,
                timeout=timeout_s,
                preexec_fn=partial(die_with_parent, os.getpid()),
            )
        except subprocess.TimeoutExpired:
            raise ProgramError(f"'{self.command}' gave no answer within {timeout_s:g} s") from None
        except OSError as error:
            raise ProgramError(f"'{self.command}' cannot be started: {error.strerror}") from error
        if done.returncode:
            raise ProgramError(f"'{self.command}' ended with exit code {done.returncode}")
        if not output.is_file():
            raise ProgramError(f"'{self.command}' ended without a file {OUTPUT}; {{}} in it writes no message")
        if output.stat().st_size > ANSWER_BYTES_MAX:
            raise ProgramError(f"'{self.command}' answers with more than {ANSWER_BYTES_MAX >> 20} MiB")
        return output.read_bytes()
