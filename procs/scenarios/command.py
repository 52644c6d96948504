"""Plays scenarios and says which succeed; without a file the book."""

import argparse
import os
import sys
import traceback
from collections.abc import Mapping, Sequence
from concurrent.futures import as_completed
from difflib import get_close_matches
from pathlib import Path

from fwk.testing import ExpressionError, Verdict
from fwk.testing.executors import executor_of
from fwk.testing.seeds import seed_argument, seeds_of
from procs.evaluation.table import as_text
from procs.scenarios.evaluation import broken_in, rows_of
from procs.scenarios.file import BOOK, Scenario, ScenarioError
from procs.scenarios.scenario import launch_file_of, outcome, read


def main() -> int:
    """Plays the scenarios of the command line; returns 0 if all succeed, 1 if one fails, 2 for a bad file."""
    parser = argparse.ArgumentParser(prog="python -m procs.scenarios", description=__doc__)
    parser.add_argument(
        "files", nargs="*", type=Path, help="scenario files; names in the book need no folder or ending"
    )
    choice = parser.add_mutually_exclusive_group()
    choice.add_argument("--seed", type=seed_argument, metavar="N", help="plays all with this seed instead of their own")
    choice.add_argument(
        "--seeds", type=_seeds, metavar="FIRST..LAST", help="plays each with all these seeds, in parallel"
    )
    parser.add_argument(
        "--launch-file",
        action="store_true",
        help="plays nothing, and prints the launch file with which fwk-launch plays a scenario in real processes",
    )
    words = parser.parse_args()
    if words.launch_file and (len(words.files) != 1 or words.seeds):
        parser.error(
            "--launch-file is that of one scenario with one seed; name one file, such as pass-reaches-the-mate"
        )
    scenarios, wrong = {}, False
    for file in words.files or sorted(BOOK.glob("*.yaml")):
        is_name = file.parent == Path() and not file.exists()
        path = BOOK / f"{file.name.removesuffix('.yaml')}.yaml" if is_name else file
        try:
            scenario = read(path)
            scenarios[path] = scenario if words.seed is None else scenario.model_copy(update={"seed": words.seed})
        except (ScenarioError, OSError) as error:
            print(_said(error, file), file=sys.stderr)
            wrong = True
    if wrong:
        return 2
    if words.launch_file:
        print(*(launch_file_of(scenario, path.stem) for path, scenario in scenarios.items()), end="")
        return 0
    return _play_often(list(scenarios), words.seeds) if words.seeds else _play_once(scenarios)


def _play_once(scenarios: Mapping[Path, Scenario]) -> int:
    failed, wrong, names = 0, False, _names(list(scenarios))
    for path, scenario in scenarios.items():
        try:
            verdict = outcome(scenario)
        except ExpressionError as error:
            print(error, file=sys.stderr)
            wrong = True
            continue
        except Exception as error:  # of a component
            traceback.print_exc()
            verdict = Verdict(broken=[f"{type(error).__name__}: {error}"])
        failed += not verdict.ok
        judged = f"ok     {names[path]}" if verdict.ok else f"failed {names[path]}, seed {scenario.seed}"
        print(
            f"{judged} ({verdict.time_s:.1f} s)",
            *verdict.broken,
            sep="\n       ",
        )
    return 2 if wrong else int(failed > 0)


def _play_often(paths: Sequence[Path], seeds: range) -> int:
    """Plays every scenario with every seed; prints how often each succeeds, and what each seed broke.

    A scenario with a mistake that only the run shows is not counted.
    """
    runs = [(path, seed) for path in paths for seed in seeds]
    names = _names(paths)
    mistakes: dict[Path, str] = {}
    with executor_of(min(os.cpu_count() or 1, len(runs))) as executor:
        futures = {executor.submit(broken_in, path, seed): (path, seed) for path, seed in runs}
        for count, future in enumerate(as_completed(futures), 1):
            path, seed = futures[future]
            failure = future.exception()
            if isinstance(failure, ScenarioError | OSError):
                if path not in mistakes:
                    mistakes[path] = _said(failure, path)
                    print(mistakes[path], file=sys.stderr)
            elif failure or future.result():
                print(f"{count} of {len(runs)}: {names[path]} failed with seed {seed}", file=sys.stderr)
        broken = {
            run: [str(failure)] if (failure := future.exception()) else future.result()
            for future, run in futures.items()
            if run[0] not in mistakes
        }
    whole = [path for path in paths if path not in mistakes]
    if whole:
        print(as_text(rows_of({names[path]: [not broken[path, seed] for seed in seeds] for path in whole})))
    for (path, seed), texts in broken.items():
        for text in texts:
            print(f"{names[path]}, seed {seed}: {text}")
    return 2 if mistakes else int(any(broken.values()))


def _names(paths: Sequence[Path]) -> dict[Path, str]:
    """Returns the names of scenarios: those of their files, with folder and ending where several are called alike."""
    stems = [path.stem for path in paths]
    return {path: path.stem if stems.count(path.stem) == 1 else str(path) for path in paths}


def _seeds(text: str) -> range:
    try:
        return seeds_of(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def _said(error: ScenarioError | OSError, file: Path) -> str:
    if isinstance(error, FileNotFoundError):
        near = get_close_matches(file.name.removesuffix(".yaml"), [each.stem for each in BOOK.glob("*.yaml")], 1)
        right = f"did you mean '{near[0]}'?" if near else f"name a file, or one of those in {BOOK} without its ending"
        return f"{file}: there is no such scenario; {right}"
    if isinstance(error, IsADirectoryError):
        return f"{file}: it is a folder; name files in it, or none to play the book"
    return f"{file}: {error.strerror}" if isinstance(error, OSError) else str(error)
