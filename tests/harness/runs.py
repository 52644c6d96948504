"""Runs `fwk-launch` as a user would, on free ports, and leaves no process behind."""

import contextlib
import os
import re
import signal
import socket
import time
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import Self

import psutil

from fwk.bus.port_lock import PortLock, PortsInUseError
from fwk.model.ports import Ports
from tests.harness import commands
from tests.harness.command_server import MARK
from tests.harness.commands import BIN

TIMEOUT_S = 60.0  # generous for a busy machine; no command takes that long in normal operation
UNHURRIED = ("--speed", "2")
"""Option of a run that goes on until its test has done something: at full speed it would take all processors."""
_BLOCK = 192
_BASES = range(21_120, 32_000, _BLOCK)  # first lock block of ports


class PortBlock:
    """Ports that no other test on this machine uses at the same time: consecutive blocks of 192 ports.

    The lock of a block is a name in the network namespace, which is also the scope of ports; it ends with its
    process.
    """

    def __init__(self, blocks: int = 1) -> None:
        for base in _BASES[: len(_BASES) - blocks + 1]:
            self._locks = [_locked(base + number * _BLOCK) for number in range(blocks)]
            if all(self._locks):
                self.bus = base
                self.public_url = f"udpm://239.255.76.67:{base + blocks * _BLOCK - 1}?ttl=0&recv_buf_size=4194304"
                return
            self.release()
        raise AssertionError("no free ports")

    def release(self) -> None:
        """Releases the ports for the next test."""
        for lock in self._locks:
            if lock:
                lock.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.release()


def _locked(base: int) -> socket.socket | None:
    """Returns the lock of a block of ports; None if a test, or a run left behind by a killed test, has it."""
    lock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        lock.bind(f"\0fwk-system-test-{base}")
        overhead = Ports(base, 0, 0).end - base
        PortLock(Ports(base, 0, _BLOCK - overhead), "test").release()
    except (OSError, PortsInUseError):
        lock.close()
        return None
    return lock


class Launched:
    """One `fwk-launch` process with all its descendants; `wrapper` is a command that runs it."""

    def __init__(
        self,
        folder: Path,
        ports: PortBlock,
        arguments: tuple[str, ...],
        env: dict[str, str],
        wrapper: tuple[str, ...] = (),
    ) -> None:
        self.folder = folder
        self._mark = uuid.uuid4().hex
        self._seen: set[psutil.Process] = set()
        self._output = folder / f"output-{self._mark}.txt"
        command = [*wrapper, str(BIN / "fwk-launch"), *arguments, "--bus-port", str(ports.bus), "--plain"]
        environment = {**os.environ, "HOME": str(folder), MARK: self._mark, **env}
        with open(self._output, "wb") as output:
            self.process = commands.start(command, folder, environment, output.fileno(), output.fileno(), session=True)

    @property
    def text(self) -> str:
        """Returns the output so far."""
        return self._output.read_text(errors="replace")

    @property
    def run_dir(self) -> Path:
        """Returns the newest run directory."""
        return max((self.folder / ".cache" / "fwk" / "runs").iterdir(), key=lambda path: path.stat().st_mtime_ns)

    def wait(self, timeout_s: float = TIMEOUT_S) -> int:
        """Waits for its end; returns the exit code."""
        return self.process.wait(timeout_s)

    def until(self, text: str) -> None:
        """Waits until the output contains `text`."""
        self.until_true(lambda: text in self.text, f"{text!r} in the output")

    def until_count(self, text: str, count: int) -> None:
        """Waits until the output contains `text` that number of times."""
        self.until_true(lambda: self.text.count(text) >= count, f"{text!r} {count} times in the output")

    def until_true(self, condition: Callable[[], bool], what: str) -> None:
        """Waits until a condition holds while the run goes on."""
        deadline = time.monotonic() + TIMEOUT_S  # noqa: TID251
        while not condition():
            assert time.monotonic() < deadline, f"{what}: not in {TIMEOUT_S} s\n{self.text}"  # noqa: TID251
            assert self.process.poll() is None or condition(), (
                f"{what}: ended before with {self.process.poll()}\n{self.text}"
            )
            pause()

    def signal(self, number: int) -> None:
        """Signals the process of the command."""
        self.process.send_signal(number)

    def processes(self) -> list[psutil.Process]:
        """Returns all living descendants, wherever in the tree: they carry a mark in their environment.

        A process that dies loses its environment before its open files, so those that were seen once are remembered.
        """
        for process in psutil.process_iter():
            try:
                if process.environ().get(MARK) == self._mark:
                    self._seen.add(process)
            except psutil.Error:
                continue
        self._seen = {process for process in self._seen if _lives(process)}
        return sorted(self._seen, key=lambda process: process.pid)

    def gone_within(self, seconds: float) -> bool:
        """Returns whether all processes end within that time."""
        deadline = time.monotonic() + seconds  # noqa: TID251
        while self.processes():
            if time.monotonic() > deadline:  # noqa: TID251
                return False
            pause()
        return True

    def zygote(self) -> int:
        """Returns the process that forks the hosts."""
        return next(child.pid for child in self._children() if child.children())

    def gateway(self) -> int:
        """Returns the gateway: leader of a session like the zygote, but without children."""
        return next(
            child.pid for child in self._children() if os.getsid(child.pid) == child.pid and not child.children()
        )

    def host(self, player: str) -> int:
        """Returns the process of a player, which writes its number to the folder `traces` that the test has made."""
        number = self._trace(player, "pid")
        assert number, f"{player} has left no trace"  # signals to 0 reach the tests
        return number

    def tick(self, player: str) -> int:
        """Returns the newest tick of a player; 0 before its first."""
        return self._trace(player, "tick")

    def until_ticks(self, player: str, number: int) -> None:
        """Waits for that number of further ticks of a player."""
        before = self.tick(player)
        self.until_true(lambda: self.tick(player) >= before + number, f"{number} more ticks of {player}")

    def _trace(self, player: str, kind: str) -> int:
        path = self.folder / "traces" / f"{player.replace('/', '_')}.{kind}"
        return int(path.read_text()) if path.exists() else 0

    def _children(self) -> list[psutil.Process]:
        return psutil.Process(self.process.pid).children()

    def end(self) -> None:
        """Kills the remaining processes."""
        for process in self.processes():
            try:
                os.kill(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                continue
        self.process.wait()


def _lives(process: psutil.Process) -> bool:
    try:
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    except psutil.Error:
        return False


def pause(seconds: float = 0.02) -> None:
    """Waits a moment between two checks."""
    time.sleep(seconds)  # noqa: TID251


def fwk(folder: Path, *words: str | Path, code: int = 0) -> str:
    """Returns the output of a command in a folder; it has to end with that exit code."""
    command = [str(BIN / "fwk"), *map(str, words)]
    done = commands.run(command, folder, {**os.environ, "HOME": str(folder)}, 2 * TIMEOUT_S)
    assert done.returncode == code, f"{words}: {done.returncode}\n{done.stdout}\n{done.stderr}"
    # On a busy machine, an answer may take longer than the second after which a command says that it waits.
    return done.stdout + re.sub("^note: no answer .*\n", "", done.stderr, flags=re.MULTILINE)


def replayed(folder: Path, *words: str, log: str | Path = "log.lcm", code: int = 0) -> str:
    """Returns the output of `fwk replay LOG --verify`, which has to find no difference unless `code` says otherwise.

    No component may be left out because it tried to reach outside: the replay would not compare its messages.
    """
    said = fwk(folder, "replay", log, "--verify", *words, code=code)
    assert code or "equal: " in said, said
    assert "which reaches outside" not in said, said
    return said


def fill(disk: Path) -> Path:
    """Creates a file that takes all free space."""
    big = disk / "big"
    with open(big, "wb", buffering=0) as file, contextlib.suppress(OSError):
        while file.write(bytes(4096)):
            pass
    return big


def write_files(folder: Path, files: dict[str, str]) -> None:
    """Writes files below a folder."""
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(content)


def played(folder: Path, files: Callable[[str], dict[str, str]], *arguments: str) -> Path:
    """The recording `log.lcm` of an undisturbed run that ends by itself; `files` gets the address of the public bus."""
    with PortBlock() as ports:
        write_files(folder, files(ports.public_url))
        run = Launched(folder, ports, arguments, {})
        try:
            assert run.wait() == 0, run.text
        finally:
            run.end()
    return folder / "log.lcm"
