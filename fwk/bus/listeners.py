"""Programs of this machine that listen on a multicast port, and whether they still process what they received."""

import contextlib
import os
from pathlib import Path

from fwk.bus.udp_sockets import owners, process_name, sockets_on
from fwk.clock import US_PER_S, monotonic_us

LOOK_US = US_PER_S
"""Wall time between two searches for programs that listen."""
FIRST_LOOK_US = US_PER_S // 20
"""The same as long as no program listens: a program that begins to listen lacks the messages of at most that time."""
THREADS_MAX = 8
"""Number of threads up to which all threads of a program are watched; of a larger one, those that ran lately."""
QUEUE_LOOK_US = 10_000
"""Wall time between two checks of the sockets; the gateway's messages of that time fit into a small socket."""
_STATE_BYTES = 128


class Listeners:
    """The listeners on a port, except this process, as far as the kernel shows them to this user.

    A listener is busy while one of its threads can run: it has not taken everything from its socket, or has not
    handled everything that it took. A listener whose threads wait has handled everything, or is paused, as a Java
    program during garbage collection. So the sockets are checked too, less often, because that takes longer.

    Args:
        port: UDP port on which the programs listen.
        own: inode of this process's own socket on that port; 0: there is none.
    """

    def __init__(self, port: int, own: int = 0) -> None:
        self._own = {str(own)} if own else set()
        self._are_shown = True  # the kernel shows the sockets of this machine, at least the own one
        self._port = port
        self._look_us = 0
        self._queue_look_us = 0
        self._held_up: list[str] = []  # names of listeners with datagrams in their sockets
        self._inodes: set[str] = set()
        self._processes: dict[str, int] = {}  # by inode of their sockets
        self._threads: dict[int, list[int]] = {}  # by process: open files with the states of its threads
        self._names: dict[int, str] = {}  # by process
        self._runs: dict[str, str] = {}  # by thread: how often it had run at the last check

    def busy(self) -> list[str] | None:
        """Returns the names of the listeners that are still busy; None if no listener exists, as the kernel shows."""
        now_us = monotonic_us()
        if now_us >= self._look_us:
            self._look()
            self._look_us = now_us + (LOOK_US if self._inodes else FIRST_LOOK_US)
        if not self._inodes:
            return None if self._are_shown else []
        found: list[str] = []
        for process, threads in list(self._threads.items()):
            try:
                # One thread may pass its work to another during a check, so all are checked twice.
                if any(_can_run(thread) for thread in threads) or any(_can_run(thread) for thread in threads):
                    found.append(self._names[process])
            except OSError:  # the program, or one of its threads, has ended
                self._forget(process)
                self._look_us = now_us
        if (self._held_up and not found) or now_us >= self._queue_look_us:
            self._queue_look_us = now_us + QUEUE_LOOK_US
            self._held_up = self._with_datagrams()
        return list(dict.fromkeys(found + self._held_up))

    def expect(self) -> None:
        """Makes the next check look for listeners at once, as a program that has sent something may also listen."""
        if not self._inodes:
            self._look_us = 0

    def close(self) -> None:
        """Closes the files with the states."""
        for process in list(self._threads):
            self._forget(process)

    def _look(self) -> None:
        """Finds the listening processes, if they have changed, and their threads."""
        found = {socket.inode for socket in sockets_on(self._port)}
        self._are_shown, inodes = self._own <= found, found - self._own
        if inodes != self._inodes:
            self._inodes = inodes
            self._processes = {inode: process for inode, process in owners(inodes) if process != os.getpid()}
            processes = list(dict.fromkeys(self._processes.values()))
        else:
            processes = list(self._threads)
        self.close()
        before, self._runs = self._runs, {}
        for process in processes:
            with contextlib.suppress(OSError):
                threads = [f"/proc/{process}/task/{thread}" for thread in os.listdir(f"/proc/{process}/task")]
                self._runs.update((thread, Path(thread, "schedstat").read_text()) for thread in threads)
                if len(threads) > THREADS_MAX:
                    threads = [thread for thread in threads if self._runs[thread] != before.get(thread)]
                self._threads[process], self._names[process] = [], _name_of(process)
                for thread in threads:
                    self._threads[process].append(os.open(f"{thread}/stat", os.O_RDONLY | os.O_CLOEXEC))

    def _with_datagrams(self) -> list[str]:
        waiting = [each.inode for each in sockets_on(self._port) if each.waiting]
        processes = [self._processes[inode] for inode in waiting if inode in self._processes]
        return [self._names.get(process, "") or _name_of(process) for process in processes]

    def _forget(self, process: int) -> None:
        for file in self._threads.pop(process):
            os.close(file)


def _can_run(thread: int) -> bool:
    return os.pread(thread, _STATE_BYTES, 0).rpartition(b")")[2][1:2] == b"R"


def _name_of(process: int) -> str:
    name = process_name(process)
    return f"{name} (process {process})" if name else f"process {process}"
