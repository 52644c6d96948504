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
from functools import partial
from importlib import import_module
from queue import SimpleQueue
from threading import Event, Lock, Thread
from typing import Any

from fwk.clock import US_PER_S, monotonic_us
from fwk.model.parent_death import die_with_parent

INSTALL = "pip install 'fwk[eval]'"
CONNECT_S = 5.0
"""Longest time for the connection to a scheduler, for its first worker, and for its answers."""
LOST_S = 30.0
"""A cluster without workers, or without an answer, for that time plays no more runs."""
_LOOK_S = 1.0
"""Time between two looks at the workers of a cluster."""


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


class _Workers(Executor):
    """Workers of a Dask cluster; once all of them are gone, the runs that have no result fail."""

    def __init__(self, client: Any, address: str) -> None:
        """Begins to look whether there are workers."""
        self._client, self._address = client, address
        self._workers: Executor = client.get_executor(pure=False)
        self._lock = Lock()
        self._open = set[Future[Any]]()
        self._lost = ""
        self._ended = Event()
        Thread(target=self._look, daemon=True).start()

    def submit(self, work: Callable[..., Any], /, *words: Any, **named: Any) -> Future[Any]:
        """Hands a call to the cluster; it fails if the cluster is lost."""
        outcome: Future[Any] = Future()
        with self._lock:
            if self._lost:
                outcome.set_exception(CampaignError(self._lost))
                return outcome
            self._open.add(outcome)
        self._workers.submit(work, *words, **named).add_done_callback(partial(self._answer, outcome))
        return outcome

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:  # noqa: ARG002 - of any executor
        """Cancels the calls that have no result, which the cluster would play although no caller waits for them."""
        self._ended.set()
        self._workers.shutdown(wait=False)

    def _answer(self, outcome: Future[Any], played: Future[Any]) -> None:
        """Hands on how a call ended."""
        if self._is_closed(outcome):
            return
        if played.cancelled():
            outcome.set_exception(CampaignError("the connection to the cluster was lost"))
        elif error := played.exception():
            outcome.set_exception(error)
        else:
            outcome.set_result(played.result())

    def _is_closed(self, outcome: Future[Any]) -> bool:
        """Returns whether a call has its outcome, or is cancelled; if not, it gets its outcome next."""
        with self._lock:
            if outcome not in self._open:
                return True
            self._open.remove(outcome)
            return not outcome.set_running_or_notify_cancel()

    def _look(self) -> None:
        """Looks for workers until the runs end; a worker that comes back in time goes on."""
        cause, there_us = "", monotonic_us()
        while monotonic_us() - there_us < LOST_S * US_PER_S:
            if self._ended.wait(_LOOK_S):
                return
            cause = self._absence()
            there_us = there_us if cause else monotonic_us()
        with self._lock:
            self._lost, left = cause, tuple(self._open)
        for outcome in left:
            if not self._is_closed(outcome):
                outcome.set_exception(CampaignError(cause))

    def _absence(self) -> str:
        """Returns why the cluster plays nothing, or an empty text."""
        try:
            if self._client.nthreads(callback_timeout=CONNECT_S):
                return ""
        except Exception:  # of any kind: a connection that is being closed, or made again
            return f"the Dask scheduler at {self._address} gave no answer for {LOST_S:g} s"
        cure = f"start some with: dask worker {self._address}"
        return f"the Dask scheduler at {self._address} had no workers for {LOST_S:g} s; {cure}"


def _begin(parent: int) -> None:
    """Prepares a process for runs: Ctrl-C and the end of the terminal are the parent's."""
    for number in (signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    die_with_parent(parent)


async def _greet(cluster: str) -> None:
    """Connects with a scheduler and leaves again; Dask's client would wait without end for the greeting of another."""
    comm = await asyncio.wait_for(import_module("distributed.comm").connect(cluster, timeout=CONNECT_S), 2 * CONNECT_S)
    comm.abort()


@contextmanager
def executor_of(jobs: int, cluster: str = "", limit_s: float | None = None) -> Iterator[Executor]:
    """Yields `jobs` processes of this machine, or the workers of the Dask cluster whose scheduler has an address.

    Ctrl-C, or an error of the caller, ends the processes of this machine at once, and a run that takes longer than the
    limit ends its process. Runs of a cluster have no limit: nothing ends a worker from outside. Each thread of its
    workers plays a run.

    Raises:
        CampaignError: Dask is not installed, there is no scheduler at that address, or it has no worker.
    """
    if not cluster:
        with Processes(jobs, limit_s) as processes:
            try:
                yield processes
            except BaseException:  # runs that have begun, or wait, would be played to their end
                processes.kill()
                raise
        return
    try:
        dask: Any = import_module("distributed")
    except ImportError as error:
        raise CampaignError(f"a cluster needs Dask, which is not installed; type: {INSTALL}") from error
    for name in ("distributed", "distributed.client"):  # failures of runs tell what it would tell at length
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        asyncio.run(_greet(cluster))
        client = dask.Client(cluster, timeout=CONNECT_S)
    except (TimeoutError, MemoryError) as error:  # MemoryError: HTTP, read as the number of bytes to come
        raise CampaignError(f"no Dask scheduler at {cluster}: another program answers, such as a dashboard") from error
    except ValueError as error:  # about a part of the address, such as '8786/'
        right = "write its address, such as tcp://192.168.1.5:8786"
        raise CampaignError(f"no Dask scheduler at {cluster}: {error}; {right}") from error
    except (OSError, TypeError) as error:  # TypeError: tls:// without certificates
        raise CampaignError(f"no Dask scheduler at {cluster}: {error}") from error
    with client:
        try:
            client.wait_for_workers(1, timeout=CONNECT_S)
        except TimeoutError as error:
            raise CampaignError(
                f"the Dask scheduler at {cluster} has no workers; start some with: dask worker {cluster}"
            ) from error
        with _Workers(client, cluster) as workers:
            yield workers
