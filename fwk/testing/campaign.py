"""Campaigns: many seeded runs at the same time, kept in a folder; an interrupted campaign resumes."""

import fcntl
import json
import os
from collections import defaultdict
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError, Executor, Future, as_completed
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from fwk.model.errors import some
from fwk.testing.differing import differing
from fwk.testing.evaluation import Work, shortened
from fwk.testing.executors import CampaignError
from fwk.testing.results import FolderError, Results, flaw_of, read_file, text_of, write_file

_NAMED = 10  # seeds of a cause that a message shows
_CODE = "code.json"
_ABSENT = "there is none"


class Campaign:
    """Results of the runs of one launch file in a folder, a file a seed."""

    def __init__(
        self, folder: Path, about: Mapping[str, Any], code: str = "", flaw_in: Callable[[Any], str] = lambda _: ""
    ) -> None:
        """Opens or begins a campaign; `about` states launch file, logical time and evaluation.

        The digest `code` of the modules is kept with each result. `flaw_in` says what is wrong with a result.

        Raises:
            FolderError: the folder holds results of another campaign, or another is played into it; or what the
                folder says about its campaign is damaged, or cannot be read or written.
            OSError: there is no folder, and none can be made.
        """
        self._folder, self._code, self._flaw_in = folder, code, flaw_in
        self._flaws: dict[int, str] = {}
        """Flaw of the result of each seed whose file was read; an empty text if the result is whole."""
        folder.mkdir(parents=True, exist_ok=True)
        self._codes = _codes_in(folder / _CODE)
        """Code that each seed's result is of."""
        self._about = dict(about)
        note, text = folder / "campaign.json", json.dumps(self._about, sort_keys=True)
        old = read_file(note)
        if old is None:
            write_file(note, text)
        elif (flaw := flaw_of(old, _flaw_in_note)) and old != text.encode():
            cure = "remove it if the results beside it are of this launch file and its settings"
            raise FolderError(f"{note} is damaged: {flaw}; {cure}, or choose another folder")
        elif (differ := differing(json.loads(old), json.loads(text))) and not self._began_anew(note, text):
            raise self._other(differ)

    def _other(self, differ: str) -> FolderError:
        return FolderError(f"{self._folder} holds another campaign: {differ}; choose another folder")

    def _began_anew(self, note: Path, text: str) -> bool:
        """Begins this campaign in the place of another that has no result and is not played; returns whether it did."""
        with suppress(CampaignError), self._locked():
            if not any(self._folder.glob("seed-*.json")):
                write_file(note, text)
                return True
        return False

    def missing(self, seeds: Iterable[int]) -> list[int]:
        """Returns the seeds without a result, or with a damaged one.

        Raises:
            FolderError: a result cannot be read.
        """
        return [seed for seed in seeds if self._flaw(seed)]

    def damaged(self, seeds: Iterable[int]) -> dict[Path, str]:
        """Returns the files of the seeds' results that are damaged, and what is wrong with each.

        Raises:
            FolderError: a result cannot be read.
        """
        found = {self._file(seed): self._flaw(seed) for seed in seeds}
        return {file: flaw for file, flaw in found.items() if flaw not in ("", _ABSENT)}

    def of_other_code(self, seeds: Iterable[int]) -> list[int]:
        """Returns the seeds whose whole results are of other code than today's; one without a note counts as today's.

        Raises:
            FolderError: a result cannot be read.
        """
        return [each for each in seeds if self._codes.get(each, self._code) != self._code and not self._flaw(each)]

    @contextmanager
    def alone(self) -> Iterator[None]:
        """Keeps others from playing into the folder; a file system without locks lets all play.

        Raises:
            CampaignError: another process plays into it.
            FolderError: another campaign has begun in it since this one was opened.
        """
        with self._locked():
            note = read_file(self._folder / "campaign.json")
            whole = json.loads(note) if note and not flaw_of(note, _flaw_in_note) else self._about
            if differ := differing(whole, self._about):
                raise self._other(differ)
            yield

    @contextmanager
    def _locked(self) -> Iterator[None]:
        """Locks the folder."""
        opened = os.open(self._folder, os.O_RDONLY)
        try:
            fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            os.close(opened)
            cure = "wait until it has ended, or choose another folder"
            raise CampaignError(f"another evaluation is playing into {self._folder}; {cure}") from error
        except OSError:
            pass
        try:
            yield
        finally:
            os.close(opened)

    def results(self, seeds: Iterable[int]) -> Results:
        """Returns the results of the seeds that have a whole one, in the order of the seeds.

        Raises:
            FolderError: a result cannot be read.
        """
        return Results({seed: self._file(seed) for seed in seeds if not self._flaw(seed)})

    def play(
        self, work: Work, file: str, time_s: float, seeds: Iterable[int], executor: Executor
    ) -> Generator[int, None, None]:
        """Plays what is missing; yields each seed as soon as its result is on the disk.

        A caller that stops early cancels the runs that have not begun.

        Raises:
            CampaignError: runs failed; all others were played and have their results.
            FolderError: a result cannot be read or written.
        """
        running = {executor.submit(work, file, time_s, seed): seed for seed in self.missing(seeds)}
        count, failures = len(running), dict[int, str]()
        try:
            for future in as_completed(running):
                seed = running.pop(future)  # a future keeps its result
                text, failure = _outcome(future)
                if not failure and (flaw := flaw_of(text.encode(), self._flaw_in)):
                    failure = f"the evaluation returned a result that is not one: {flaw}"
                if failure:
                    failures[seed] = failure
                    continue
                self._codes[seed] = self._code
                # The code first: no result is there with another one.
                write_file(self._folder / _CODE, json.dumps(self._codes))
                write_file(self._file(seed), text)
                self._flaws[seed] = ""
                yield seed
        except KeyboardInterrupt:  # the executor ends all runs; one that is cancelled before makes it print an error
            running = {}
            raise
        finally:
            for future in running:
                future.cancel()
        if failures:
            raise CampaignError(f"{len(failures)} of {count} runs failed: {_causes(failures)}")

    def _flaw(self, seed: int) -> str:
        """Returns why a seed has no result that counts, or an empty text; a file is read once, as it may be large."""
        if seed not in self._flaws:
            content = read_file(self._file(seed))
            self._flaws[seed] = _ABSENT if content is None else flaw_of(content, self._flaw_in)
        return self._flaws[seed]

    def _file(self, seed: int) -> Path:
        return self._folder / f"seed-{seed}.json"


def _flaw_in_note(value: Any) -> str:
    """Returns why a value is not what is stated about a campaign, or an empty text."""
    return "" if isinstance(value, dict) else "it is no JSON object"


def _outcome(future: Future[Any]) -> tuple[str, str]:
    """Returns the text of a run's result, or why it has none."""
    try:
        error = future.exception()
        if error is None:
            return text_of(future.result()), ""
    except CancelledError:
        return "", "the connection to the cluster was lost"
    except (CampaignError, TypeError, ValueError, RecursionError) as flaw:  # what JSON does not know
        error = flaw
    if isinstance(error, CampaignError):
        return "", str(error)
    return "", ": ".join(filter(None, (type(error).__name__, shortened(str(error)))))


def _causes(failures: Mapping[int, str]) -> str:
    """Returns the causes of failures, each with its seeds."""
    seeds = defaultdict[str, list[int]](list)
    for seed, cause in sorted(failures.items()):
        seeds[cause].append(seed)
    return "; ".join(f"seed{'s' * (len(each) > 1)} {listed(each)}: {cause}" for cause, each in seeds.items())


def listed(seeds: Sequence[int]) -> str:
    """Returns the seeds, the first of them if they are many: `1, 2, 3`."""
    return some(seeds, _NAMED)


def _codes_in(file: Path) -> dict[int, str]:
    """Returns the code of each seed's result; a file that is damaged tells nothing."""
    try:
        return {int(seed): str(code) for seed, code in json.loads(read_file(file) or b"{}").items()}
    except (ValueError, AttributeError, RecursionError):
        return {}
