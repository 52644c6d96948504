"""Executors of a campaign's runs: processes of this machine, or the workers of a Dask cluster."""

import logging
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
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

    def __init__(self, jobs: int) -> None:
        self._others = multiprocessing.active_children()
        self._lock = Lock()
        self._ended = False
        self._idle: SimpleQueue[ProcessPoolExecutor] = SimpleQueue()
        for _ in range(jobs):
            self._idle.put(self._begun())
        self._threads = ThreadPoolExecutor(jobs)  # a thread waits for each process; the kernel ends those of dead ones

    def submit(self, work: Callable[..., Any], /, *words: Any, **named: Any) -> Future[Any]:
        """Hands a call to the next process that is idle."""
        return self._threads.submit(self._run, work, words, named)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Ends the processes after the calls that wait, or that have begun if the others are cancelled."""
        self._threads.shutdown(wait, cancel_futures=cancel_futures)
        while not self._idle.empty():
            self._idle.get().shutdown(wait)

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
            return process.submit(work, *words, **named).result()
        except BrokenProcessPool as error:
            process.shutdown()
            with self._lock:
                if not self._ended:
                    process = self._begun()
            raise CampaignError("its process died; perhaps a program killed it, or the memory was full") from error
        finally:
            self._idle.put(process)

    @staticmethod
    def _begun() -> ProcessPoolExecutor:
        """Returns a process that has begun; one at a time, as each inherits the files that are open."""
        process = ProcessPoolExecutor(1, initializer=_begin, initargs=(os.getpid(),))
        process.submit(os.getpid)
        return process


def _begin(parent: int) -> None:
    """Prepares a process for runs: Ctrl-C is the parent's."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    die_with_parent(parent)


@contextmanager
def executor_of(jobs: int, cluster: str = "") -> Iterator[Executor]:
    """Yields `jobs` processes of this machine, or the workers of the Dask cluster whose scheduler has an address.

    Ctrl-C ends the processes of this machine at once.

    Raises:
        CampaignError: Dask is not installed, there is no scheduler at that address, or it has no worker.
    """
    if not cluster:
        with Processes(jobs) as processes:
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
        client = dask.Client(cluster, timeout=CONNECT_S)
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
