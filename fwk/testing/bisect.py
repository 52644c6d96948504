"""Finds the commit that changed what components write: git's bisection with a replay at each commit."""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

HASH_DIGITS = 12
_GOES_ON, _LAST, _SEVERAL = "Bisecting:", "is the first bad commit", "could be any of"
"""Sentences of `git bisect`."""
_OWN = Path(__file__).resolve().parents[2]
"""Folder of this fwk, which replays the code of all commits."""


class BisectError(Exception):
    """A search that cannot be made; the text says why."""


@dataclass(frozen=True)
class Commit:
    """A commit that was tried."""

    revision: str
    subject: str
    tick: int | None = None
    """First tick in which the condition holds; None: in none."""
    text: str = ""
    """The difference there."""
    unusable: str = ""
    """Why the recording cannot be replayed with it; empty: it can."""

    def __str__(self) -> str:
        found = f"holds from tick {self.tick} on" if self.tick is not None else "does not hold"
        return f"{self.revision} {self.subject}: {self.unusable.splitlines()[0] if self.unusable else found}"


@dataclass(frozen=True)
class Found:
    """Result of a search."""

    commits: list[Commit]
    """The first commit where the condition holds; several if those between could not be replayed."""
    tried: list[Commit]


def repository_of(folders: Sequence[str]) -> Path:
    """Returns the git repository that contains one of these folders.

    Raises:
        BisectError: none of them is in a repository.
    """
    for folder in folders:
        done = _run("git", "-C", folder, "rev-parse", "--show-toplevel")
        if done.returncode == 0:
            return Path(done.stdout.strip())
    raise BisectError(
        f"no git repository contains {' or '.join(folders) or 'the code of the run'}; name it with --repo"
    )


def bisect(
    log: Path,
    repository: Path,
    good: str,
    bad: str,
    condition: str,
    only: Sequence[str] = (),
    say: Callable[[Commit], None] = lambda _: None,
) -> Found:
    """Searches between two commits for the first one where a condition holds.

    Args:
        log: the recording.
        repository: the git repository of the code.
        good: revision where the condition does not hold.
        bad: later revision where it holds.
        condition: `differs`, or a condition over messages.
        only: components to replay; none means all.
        say: gets each commit when it has been tried.

    Raises:
        BisectError: a revision does not exist, the condition does not part them, or it cannot be understood.
    """
    ends = [_revision(repository, each) for each in (good, bad)]
    tried: list[Commit] = []
    with _worktree(repository, ends[1]) as worktree:

        def look() -> Commit:
            tried.append(_probe(log, repository, worktree, condition, only))
            say(tried[-1])
            return tried[-1]

        _need(look(), bad, True)
        _git(worktree, "checkout", "--quiet", ends[0])
        _need(look(), good, False)
        said = _git(worktree, "bisect", "start", ends[1], ends[0])
        while _LAST not in said and _SEVERAL not in said:
            if _GOES_ON not in said:
                raise BisectError(f"git bisect cannot go on: {said.strip() or 'it says nothing'}")
            commit = look()
            word = "skip" if commit.unusable else "good" if commit.tick is None else "bad"
            said = _git(worktree, "bisect", word, refused=True)
        return Found(_first(worktree, said, tried), tried)


def _first(worktree: Path, said: str, tried: Sequence[Commit]) -> list[Commit]:
    """Returns the commits that git names."""
    lines = said.splitlines()
    if _SEVERAL in said:
        begin = next(number for number, line in enumerate(lines) if _SEVERAL in line)
        revisions = [line for line in lines[begin + 1 :] if len(line) >= 40 and " " not in line]
    else:
        revisions = [next(line for line in lines if _LAST in line).split()[0]]
    known = {commit.revision: commit for commit in tried}
    made = [_described(worktree, revision) for revision in revisions]
    return [known.get(commit.revision, commit) for commit in made]


def _need(commit: Commit, named: str, holds: bool) -> None:
    if commit.unusable:
        raise BisectError(f"{named} cannot be replayed: {commit.unusable}")
    if (commit.tick is not None) != holds:
        other = "does not hold there" if holds else f"holds there too, from tick {commit.tick} on: {commit.text}"
        option = "--bad" if holds else "--good"
        raise BisectError(f"{option} {named}: the condition {other.removesuffix(': ')}; choose another revision")


def _probe(log: Path, repository: Path, worktree: Path, condition: str, only: Sequence[str]) -> Commit:
    """Replays with the code of the worktree, in a process of its own."""
    here = Path.cwd()
    folder = worktree / here.relative_to(repository) if here.is_relative_to(repository) else worktree
    # Without -B, a file that a checkout changes twice in a second could be taken for its compiled former self.
    words = [sys.executable, "-B", "-P", "-m", "fwk.testing.probe", str(log), str(repository), str(worktree)]
    environment = {**os.environ, "PYTHONPATH": str(_OWN)}
    done = subprocess.run(
        [*words, condition, *only],
        cwd=folder if folder.is_dir() else worktree,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    commit = _described(worktree, "HEAD")
    lines = done.stdout.splitlines()
    answer: dict[str, Any] = json.loads(lines[-1]) if done.returncode == 0 and lines else {"unusable": done.stderr}
    if "mistake" in answer:
        raise BisectError(f"--when: {answer['mistake']}")
    if unusable := answer.get("unusable"):
        return Commit(commit.revision, commit.subject, unusable=unusable)
    return Commit(commit.revision, commit.subject, answer["tick"], answer["text"])


def _described(folder: Path, revision: str) -> Commit:
    name, _, subject = _git(folder, "log", "-1", "--format=%H %s", revision).strip().partition(" ")
    return Commit(name[:HASH_DIGITS], subject)


def _revision(repository: Path, text: str) -> str:
    done = _run("git", "-C", str(repository), "rev-parse", "--verify", "--quiet", f"{text}^{{commit}}")
    if done.returncode:
        raise BisectError(f"no commit '{text}' in {repository}")
    return done.stdout.strip()


@contextmanager
def _worktree(repository: Path, revision: str) -> Iterator[Path]:
    """Gives a worktree in a temporary folder; the user's own one is not touched."""
    with tempfile.TemporaryDirectory(prefix="fwk-bisect-") as folder:
        worktree = Path(folder, "code")
        _git(repository, "worktree", "add", "--quiet", "--detach", str(worktree), revision)
        try:
            yield worktree.resolve()
        finally:
            _run("git", "-C", str(repository), "worktree", "remove", "--force", str(worktree))


def _git(folder: Path, *words: str, refused: bool = False) -> str:
    """Returns the output of git; `refused`: git may exit with an error, as it does if only skipped commits are left."""
    done = _run("git", "-C", str(folder), *words)
    if done.returncode and not refused:
        raise BisectError(f"git {' '.join(words)}: {done.stderr.strip()}")
    return done.stdout


def _run(*command: str) -> "subprocess.CompletedProcess[str]":
    environment = {**os.environ, "LC_ALL": "C"}  # the sentences of git in English
    try:
        return subprocess.run(
            command, env=environment, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL
        )
    except FileNotFoundError as error:
        raise BisectError("git is not installed; type: sudo apt install git") from error
