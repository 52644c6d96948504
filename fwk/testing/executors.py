"""Executors of a campaign's runs: processes of this machine, or the workers of a Dask cluster."""

import asyncio
import logging
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from importlib import import_module
from queue import SimpleQueue
from threading import Lock
from typing import Any

from fwk.model.parent_death import die_with_parent

INSTALL = "pip install 'fwk[eval]'"
CONNECT_S = 5.0
"""Longest time for the connection to a scheduler, and for its first worker."""


class CampaignError(RuntimeError):
    """A campaign that cannot be played."""


class Processes(Executor):
    """Processes of this machine; one that dies fails its own run alone, and a new one takes its place."""

    def __init__(self, jobs: int, limit_s: float | None = None) -> None:
        """Begins the processes; a call that takes longer than the limit fails, and its process is ended."""
        self._limit_s = limit_s
        self._others = multiprocessing.active_children()
        self._lock = Lock()
        self._ended = False
        self._idle: SimpleQueue[_Process] = SimpleQueue()
        for _ in range(jobs):
            self._idle.put(_Process())
        self._threads = ThreadPoolExecutor(jobs)  # a thread waits for each process; the kernel ends those of dead ones

    def submit(self, work: Callable[..., Any], /, *words: Any, **named: Any) -> Future[Any]:
        """Hands a call to the next process that is idle."""
        return self._threads.submit(self._run, work, words, named)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Ends the processes after the calls that wait, or that have begun if the others are cancelled."""
        self._threads.shutdown(wait, cancel_futures=cancel_futures)
        while not self._idle.empty():
            self._idle.get().pool.shutdown(wait)

    def kill(self) -> None:
        """Ends all calls at once: those that have begun, and those that wait."""
        with self._lock:
            self._ended = True
        self._threads.shutdown(wait=False, cancel_futures=True)
        for worker in multiprocessing.active_children():
            if worker not in self._others:
                worker.kill()

    def _run(self, work: Callable[..., Any], words: tuple[Any, ...], named: dict[str, Any]) -> Any:
        process = self._idle.get()
        try:
            running = process.pool.submit(work, *words, **named)
            if process.overruns(running, self._limit_s):
                process = self._renewed(process)
                raise CampaignError(f"it took longer than --limit, {self._limit_s:g} s, and was ended")
            return running.result()
        except BrokenProcessPool as error:
            process = self._renewed(process)
            raise CampaignError("its process died; perhaps a program killed it, or the memory was full") from error
        finally:
            self._idle.put(process)

    def _renewed(self, process: "_Process") -> "_Process":
        """Returns a new process in the place of a dead one, as long as calls may come."""
        process.pool.shutdown()
        with self._lock:  # one at a time, as each inherits the files that are open
            return process if self._ended else _Process()


class _Process:
    """A process that has begun, for one call at a time."""

    def __init__(self) -> None:
        self.pool = ProcessPoolExecutor(1, initializer=_begin, initargs=(os.getpid(),))
        self._pid = self.pool.submit(os.getpid)

    def overruns(self, running: Future[Any], limit_s: float | None) -> bool:
        """Waits for a call; ends the process, and returns True, if the call takes longer than the limit."""
        pid = self._pid.result()
        if limit_s is None or wait((running,), limit_s).done:
            return False
        os.kill(pid, signal.SIGKILL)
        return True


def _begin(parent: int) -> None:
    """Prepares a process for runs: Ctrl-C is the parent's."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    die_with_parent(parent)


async def _greet(cluster: str) -> None:
    """Connects with a scheduler and leaves again; Dask's client would wait without end for the greeting of another."""
    comm = await asyncio.wait_for(import_module("distributed.comm").connect(cluster, timeout=CONNECT_S), 2 * CONNECT_S)
    comm.abort()


@contextmanager
def executor_of(jobs: int, cluster: str = "", limit_s: float | None = None) -> Iterator[Executor]:
    """Yields `jobs` processes of this machine, or the workers of the Dask cluster whose scheduler has an address.

    Ctrl-C ends the processes of this machine at once, and a run that takes longer than the limit ends its process.
    Runs of a cluster have no limit: nothing ends a worker from outside.

    Raises:
        CampaignError: Dask is not installed, there is no scheduler at that address, or it has no worker.
    """
    if not cluster:
        with Processes(jobs, limit_s) as processes:
            try:
                yield processes
            except KeyboardInterrupt:  # runs that have begun, or wait, would be played to their end
                processes.kill()
                raise
        return
    try:
        dask: Any = import_module("distributed")
    except ImportError as error:
        raise CampaignError(f"a cluster needs Dask, which is not installed; type: {INSTALL}") from error
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # failures of runs tell what it would tell at length
    try:
        asyncio.run(_greet(cluster))
        client = dask.Client(cluster, timeout=CONNECT_S)
    except (TimeoutError, MemoryError) as error:  # MemoryError: HTTP, read as the number of bytes to come
        raise CampaignError(f"no Dask scheduler at {cluster}: another program answers, such as a dashboard") from error
    except (OSError, ValueError, TypeError) as error:  # TypeError: tls:// without certificates
        raise CampaignError(f"no Dask scheduler at {cluster}: {error}") from error
    with client:
        try:
            client.wait_for_workers(1, timeout=CONNECT_S)
        except TimeoutError as error:
            raise CampaignError(
                f"the Dask scheduler at {cluster} has no workers; start some with: dask worker {cluster}"
            ) from error
        with client.get_executor(pure=False) as workers:
            yield workers
