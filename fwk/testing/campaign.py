"""Campaigns: many seeded runs at the same time, with a file for each result; an interrupted campaign resumes."""

import errno
import fcntl
import json
import os
import re
import stat
from collections import defaultdict
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError, Executor, Future, as_completed
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, cast, overload

from fwk.component.log import own_frame
from fwk.engine.failures import ComponentFailedError
from fwk.engine.metrics import told
from fwk.lcm.type_registry import put_first, use_types_of
from fwk.model.errors import some
from fwk.plan.classes import find_object
from fwk.plan.what_ran import hash_of_module
from fwk.testing.differing import check_plan, differing
from fwk.testing.executors import CampaignError

Work = Callable[..., Any]
"""Plays a launch file for a logical time with a seed; returns the measurements as plain values for JSON.

Settings that the launch file's own are overridden with are a fourth argument, if there are some.
"""
_hash_in_use = lru_cache(maxsize=None)(hash_of_module)
"""A process goes on with a module as it was when it first used it, whatever becomes of the file."""
_SHOWN, _NAMED = 300, 10  # letters of a failure, and seeds of a cause, that a message shows
_CODE = "code.json"
_ABSENT = "there is none"
_UNKNOWN_TO_JSON = {"Infinity": "1e999", "-Infinity": "-1e999", "NaN": "null"}
"""Values that JSON lacks, as Python writes them, and their JSON: readers take `1e999` for infinity."""
_TEXT_OR_UNKNOWN = re.compile(r'"(?:[^"\\]|\\.)*"|-?Infinity|NaN')
_CURES = dict.fromkeys((errno.ENOSPC, errno.EDQUOT), "make room for it there, or ") | dict.fromkeys(
    (errno.EACCES, errno.EPERM), "allow yourself to write there, or "
)
_EMPTY: tuple[Any, ...] = ("", {}, [])
"""Values without a measurement."""


class FolderError(CampaignError):
    """A folder that cannot hold a campaign: it holds another one, or a file that is damaged or cannot be used."""


@dataclass(frozen=True)
class Evaluation:
    """The evaluation of a launch file, found by its name in the process that plays the run."""

    use: str
    """`module:function`."""
    folders: tuple[str, ...] = ()
    """Folders of the launch file's modules and message types, besides the installed ones."""
    sets: tuple[str, ...] = ()
    """Settings to override: `PATH=VALUE`."""
    modules: Mapping[str, str] = field(default_factory=dict)
    """Modules that the process must have, with the hashes of their files; a worker of a cluster may have others."""
    plan: str = ""
    """Digest of the plan that the process must play; empty for any."""

    def __call__(self, file: str, time_s: float, seed: int) -> Any:
        """Plays a run and returns its measurements.

        Raises:
            CampaignError: this process has other modules or another launch file, or the run failed; the text names a
                component that did.
        """
        for folder in self.folders:
            use_types_of(Path(folder))
        put_first(self.folders)
        work = cast(Work, find_object(self.use, self.folders))
        other = [name for name, digest in self.modules.items() if _hash_in_use(name) != digest]
        if other:
            more = f" and {len(other) - 1} more" if len(other) > 1 else ""
            cure = "copy the code to its machine if it has a copy of its own, and restart the worker"
            raise CampaignError(f"a worker has other code of {other[0]}{more}; {cure}")
        try:
            if self.plan:
                check_plan(file, self.sets, self.plan)
            return work(file, time_s, seed, self.sets) if self.sets else work(file, time_s, seed)
        except CampaignError:
            raise
        except Exception as error:  # of any kind; some do not reach another process, alone or as a cause
            failure = failure_of(error)
        raise CampaignError(failure)


class Results(Sequence[Any]):
    """Results of runs, each read from its file when it is asked for: together they may fill the memory."""

    def __init__(self, files: Mapping[int, Path]) -> None:
        """Takes the file of each seed's result."""
        self.seeds = list(files)
        """Seed of each result."""
        self._files = list(files.values())

    def __len__(self) -> int:
        return len(self._files)

    @overload
    def __getitem__(self, index: int) -> Any: ...
    @overload
    def __getitem__(self, index: slice) -> "Results": ...
    def __getitem__(self, index: int | slice) -> Any:
        if isinstance(index, slice):
            return Results(dict(zip(self.seeds[index], self._files[index], strict=True)))
        return json.loads(self._files[index].read_text())


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
        old = _read(note)
        if old is None:
            _write(note, text)
        elif (flaw := _flaw_of(old, _flaw_in_note)) and old != text.encode():
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
                _write(note, text)
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
            note = _read(self._folder / "campaign.json")
            whole = json.loads(note) if note and not _flaw_of(note, _flaw_in_note) else self._about
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

    def results(self, seeds: Iterable[int]) -> "Results":
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
                if not failure and (flaw := _flaw_of(text.encode(), self._flaw_in)):
                    failure = f"the evaluation returned a result that is not one: {flaw}"
                if failure:
                    failures[seed] = failure
                    continue
                self._codes[seed] = self._code
                _write(self._folder / _CODE, json.dumps(self._codes))  # first: no result is there with another code
                _write(self._file(seed), text)
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
            content = _read(self._file(seed))
            self._flaws[seed] = _ABSENT if content is None else _flaw_of(content, self._flaw_in)
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
            return _text_of(future.result()), ""
    except CancelledError:
        return "", "the connection to the cluster was lost"
    except (CampaignError, TypeError, ValueError, RecursionError) as flaw:  # what JSON does not know
        error = flaw
    if isinstance(error, CampaignError):
        return "", str(error)
    return "", ": ".join(filter(None, (type(error).__name__, _short(str(error)))))


def failure_of(error: Exception) -> str:
    """Returns an exception of an application with its place, and with the component that raised it if one did.

    The tick is left out, so that runs that fail at the same place have the same cause.
    """
    raised: BaseException = error
    context = error.__context__
    if isinstance(error, ComponentFailedError):
        raised, context = error.__cause__ or error, error
    frame = own_frame(raised)
    place = f" ({frame.filename}:{frame.lineno})" if frame else ""
    failed = f"{context}".partition(": ")[0] if isinstance(context, ComponentFailedError) else ""
    return f"{_short(': '.join(filter(None, (failed, told(raised)))))}{place}"


def _short(text: str) -> str:
    """Returns a text in one line, and the beginning of a long one."""
    line = " ".join(text.split())
    return f"{line[:_SHOWN]} ..." if len(line) > _SHOWN else line


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
        return {int(seed): str(code) for seed, code in json.loads(_read(file) or b"{}").items()}
    except (ValueError, AttributeError, RecursionError):
        return {}


def _text_of(result: Any) -> str:
    """Returns the text of a result, in plain JSON.

    Raises:
        CampaignError: it has no measurements.
        TypeError: it has values that JSON does not know.
    """
    if result in _EMPTY:
        raise CampaignError(f"the evaluation returned {result!r}, which has no measurements")
    text = json.dumps(result)
    return _TEXT_OR_UNKNOWN.sub(lambda found: _UNKNOWN_TO_JSON.get(found[0], found[0]), text)


def _flaw_of(content: bytes, flaw_in: Callable[[Any], str] = lambda _: "") -> str:
    """Returns what is wrong with the content of a file, or with the value that it holds, or an empty text."""
    try:
        value = json.loads(content)
    except (ValueError, RecursionError) as error:
        return f"it is no JSON ({error})" if content else "it is empty"
    return "it says nothing" if value in _EMPTY else flaw_in(value)


def _read(file: Path) -> bytes | None:
    """Returns the content of a file, or None if there is none.

    Raises:
        FolderError: the file cannot be read.
    """
    reason = "it is no file"
    try:
        kind = file.stat().st_mode
        if stat.S_ISREG(kind) or stat.S_ISDIR(kind):  # any other, such as a pipe or a device, may never end
            return file.read_bytes()
    except FileNotFoundError:
        if not file.is_symlink():
            return None
        reason = f"it is a link to {file.readlink()}, which does not exist"
    except OSError as error:
        reason = f"{error.strerror}"
    raise FolderError(f"{file} cannot be read: {reason}; move it away, or choose another folder")


def cure_of(error: OSError) -> str:
    """Returns what helps where a file cannot be written."""
    return f"{_CURES.get(error.errno or 0, '')}choose another folder"


def _write(file: Path, text: str) -> None:
    """Writes a file in one step: it is whole or not there.

    Raises:
        FolderError: the file cannot be written.
    """
    partial = file.with_name(f".{file.stem}.{os.getpid()}")
    try:
        with open(partial, "w", encoding="utf-8") as opened:
            opened.write(text)
            opened.flush()
            os.fsync(opened.fileno())
        partial.replace(file)
    except OSError as error:
        raise FolderError(f"{file} cannot be written: {error.strerror}; {cure_of(error)}") from error
    finally:  # also after Ctrl-C in the middle
        with suppress(OSError):
            partial.unlink()
