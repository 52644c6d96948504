"""Campaigns: many seeded runs at the same time, each kept in a file, so that an interrupted campaign goes on."""

import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import Executor, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any

Work = Callable[[str, float, int], Any]
"""Plays a launch file for a logical time with a seed; returns what was measured, as plain values for JSON."""
INSTALL = "pip install distributed"


class CampaignError(RuntimeError):
    """A campaign that cannot be played."""


class Campaign:
    """Results of the runs of one launch file in a folder, a file a seed."""

    def __init__(self, folder: Path, about: Mapping[str, Any]) -> None:
        """Opens or begins a campaign; `about` says what is played.

        Raises:
            CampaignError: the folder holds another campaign.
        """
        self._folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        note, text = folder / "campaign.json", json.dumps(dict(about), sort_keys=True)
        if note.exists() and note.read_text() != text:
            raise CampaignError(f"{folder} holds another campaign: {note.read_text()}; choose another folder")
        note.write_text(text)

    def missing(self, seeds: Iterable[int]) -> list[int]:
        """Returns the seeds without a result."""
        return [seed for seed in seeds if not self._file(seed).exists()]

    def results(self, seeds: Iterable[int]) -> list[Any]:
        """Returns the results of the seeds that have one, in the order of the seeds."""
        return [json.loads(self._file(seed).read_text()) for seed in seeds if self._file(seed).exists()]

    def play(self, work: Work, file: str, time_s: float, seeds: Iterable[int], executor: Executor) -> Iterator[int]:
        """Plays what is missing; yields each seed as soon as its result is on the disk.

        Raises:
            Exception: whatever a run raises; the results of the others stay.
        """
        running = {executor.submit(work, file, time_s, seed): seed for seed in self.missing(seeds)}
        for future in as_completed(running):
            seed = running[future]
            self._keep(seed, future.result())
            yield seed

    def _keep(self, seed: int, result: Any) -> None:
        """Writes a result in one step: a file is whole or not there."""
        partial = self._folder / f".{seed}.{os.getpid()}"
        partial.write_text(json.dumps(result))
        partial.replace(self._file(seed))

    def _file(self, seed: int) -> Path:
        return self._folder / f"seed-{seed}.json"


@contextmanager
def executor_of(jobs: int, cluster: str = "") -> Iterator[Executor]:
    """Gives processes of this machine, or the workers of a Dask cluster by the address of its scheduler.

    Raises:
        CampaignError: Dask is not installed, or there is no scheduler at that address.
    """
    if not cluster:
        with ProcessPoolExecutor(jobs) as pool:
            yield pool
        return
    try:
        dask: Any = import_module("distributed")
    except ImportError as error:
        raise CampaignError(f"a cluster needs Dask, which is not installed: {INSTALL}") from error
    try:
        client = dask.Client(cluster, timeout=5)
    except (OSError, ValueError) as error:
        raise CampaignError(f"no Dask scheduler at {cluster}: {error}") from error
    with client, client.get_executor(pure=False) as workers:
        yield workers
