"""A program as a child process that answers one request after the other through its standard streams."""

import contextlib
import os
import select
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from fwk.clock import US_PER_S, monotonic_us
from fwk.model.parent_death import die_with_parent

ANSWER_BYTES_MAX = 64 << 20
_PIECE = 1 << 16
_EXIT_S = 1.0
"""Time that a program has to end after its last answer."""


class ProgramError(Exception):
    """A program could not be started, has ended, or gave no valid answer; the text names the program and the reason."""


def find_words(command: Sequence[str], folders: Sequence[str] = ()) -> list[str]:
    """Returns a command with the files that it names as absolute paths.

    A word with a slash is looked for in the current folder, in `folders`, and where modules are looked for.
    """
    places = [Path.cwd(), *(Path(each) for each in (*folders, *sys.path) if each)]
    return [
        next((str(place / word) for place in places if "/" in word and (place / word).is_file()), word)
        for word in command
    ]


def missing_program(command: Sequence[str], folders: Sequence[str]) -> str:
    """Returns why the program of a command cannot be started; empty: it is there."""
    word = command[0]
    found = find_words([word], folders)[0]
    if shutil.which(found):
        return ""
    if os.path.isfile(found):
        return f"'{word}' is not executable; type: chmod +x {found}"
    where = (
        "beside the launch file or in the folder above it" if "/" in word else "on the path; for a file write ./NAME"
    )
    return f"no program '{word}' {where}{_how_to_build(word, folders)}"


def _how_to_build(word: str, folders: Sequence[str]) -> str:
    """Returns what builds a program, as the end of a sentence; empty: no Makefile is in its folder, or above it."""
    for place in (Path.cwd(), *map(Path, folders)):
        for folder in Path(word).parents if "/" in word else ():
            if (place / folder / "Makefile").is_file():
                return f"; it may have to be built: make -C {os.path.relpath(place / folder)}"
    return ""


class ChildProcess:
    """A running program; it dies with this process. Its standard error is that of this process."""

    def __init__(self, command: Sequence[str]) -> None:
        """Starts the program.

        Raises:
            ProgramError: it cannot be started.
        """
        self.command = " ".join(command)
        words = find_words(command)
        try:
            self._process = subprocess.Popen(
                words,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                bufsize=0,
                preexec_fn=partial(die_with_parent, os.getpid()),
            )
        except OSError as error:
            reason = "there is no such program" if isinstance(error, FileNotFoundError) else error.strerror
            raise ProgramError(f"'{self.command}' cannot be started: {reason}") from error
        assert self._process.stdin
        assert self._process.stdout
        self.pid = self._process.pid
        self._in, self._out = self._process.stdin.fileno(), self._process.stdout.fileno()
        os.set_blocking(self._in, False)
        self._ended = os.pidfd_open(self.pid)

    def exchange(self, request: bytes, length_of: Callable[[bytearray, int], int], timeout_s: float | None) -> bytes:
        """Sends a request and waits for the whole answer.

        Args:
            request: bytes for the program's standard input.
            length_of: returns the length of the answer that begins with the given bytes; 0: not known yet. Its
                second argument is the number of bytes that it was asked about before.
            timeout_s: wall time after which the program has failed; None: no limit.

        Raises:
            ProgramError: the program ended, answered with too much, or not in time. It is killed then.
        """
        try:
            return self._exchange(request, length_of, timeout_s)
        except BaseException:
            self.kill()
            raise

    def _exchange(self, request: bytes, length_of: Callable[[bytearray, int], int], timeout_s: float | None) -> bytes:
        until_us = None if timeout_s is None else monotonic_us() + round(timeout_s * US_PER_S)
        left, answer, length = memoryview(request), bytearray(), 0
        while left or not length or len(answer) < length:
            wait_s = None if until_us is None else max(0, until_us - monotonic_us()) / US_PER_S
            readable, writable, _ = select.select([self._out, self._ended], [self._in] if left else [], [], wait_s)
            if not readable and not writable:
                raise ProgramError(f"'{self.command}' gave no answer within {timeout_s:g} s")
            if writable:
                try:
                    left = left[os.write(self._in, left[:_PIECE]) :]
                except BrokenPipeError:
                    raise ProgramError(f"'{self.command}' {self._end()}") from None
            if self._out in readable and (piece := os.read(self._out, _PIECE)):
                answer += piece
                length = length or length_of(answer, len(answer) - len(piece))
                if max(length, len(answer)) > ANSWER_BYTES_MAX:
                    raise ProgramError(f"'{self.command}' answers with more than {ANSWER_BYTES_MAX >> 20} MiB")
            elif readable and not left:
                raise ProgramError(f"'{self.command}' {self._end()}")
        if len(answer) > length:
            raise ProgramError(f"'{self.command}' answers with more than one answer: {bytes(answer[length:][:80])!r}")
        return bytes(answer)

    def close(self) -> None:
        """Tells the program by the end of its input that there is nothing more, and kills it if it does not end."""
        if self._process.returncode is None:
            assert self._process.stdin
            self._process.stdin.close()
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(_EXIT_S)
        self.kill()

    def kill(self) -> None:
        """Kills the program, if it runs."""
        if self._ended < 0:
            return
        if self._process.poll() is None:
            self._process.kill()
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout):
            if stream:
                stream.close()
        os.close(self._ended)
        self._ended = -1

    def _end(self) -> str:
        """Returns how the program ended, or that it closed its output."""
        try:
            code = self._process.wait(_EXIT_S)
        except subprocess.TimeoutExpired:
            return "has closed its standard streams without an answer"
        return f"was killed by signal {-code}" if code < 0 else f"ended with exit code {code} and without an answer"
