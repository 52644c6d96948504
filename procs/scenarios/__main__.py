"""Plays scenarios and says which succeed: `python -m procs.scenarios [--seed N] [FILE...]`; without a file the book."""

import argparse
import sys
import traceback
from difflib import get_close_matches
from pathlib import Path

from fwk.testing import ExpressionError, Verdict
from procs.scenarios.file import BOOK, ScenarioError
from procs.scenarios.scenario import outcome, read


def main() -> int:
    """Plays the scenarios of the command line; returns 0 if all succeed, 1 if one fails, 2 for a bad file."""
    parser = argparse.ArgumentParser(prog="python -m procs.scenarios", description=__doc__)
    parser.add_argument(
        "files", nargs="*", type=Path, help="scenario files; names in the book need no folder or ending"
    )
    parser.add_argument("--seed", type=_seed, metavar="N", help="plays all with this seed instead of their own")
    words = parser.parse_args()
    scenarios, wrong = {}, False
    for file in words.files or sorted(BOOK.glob("*.yaml")):
        path = file if file.exists() else BOOK / f"{file.name.removesuffix('.yaml')}.yaml"
        try:
            scenario = read(path)
            scenarios[path] = scenario if words.seed is None else scenario.model_copy(update={"seed": words.seed})
        except (ScenarioError, OSError) as error:
            print(_said(error, file), file=sys.stderr)
            wrong = True
    if wrong:
        return 2
    failed = 0
    for path, scenario in scenarios.items():
        try:
            verdict = outcome(scenario)
        except ExpressionError as error:
            print(f"{path}: {error}", file=sys.stderr)
            wrong = True
            continue
        except Exception as error:  # of a component
            traceback.print_exc()
            verdict = Verdict(broken=[f"{type(error).__name__}: {error}"])
        failed += not verdict.ok
        print(
            f"{'ok    ' if verdict.ok else 'failed'} {path.stem} ({verdict.time_s:.1f} s)",
            *verdict.broken,
            sep="\n       ",
        )
    return 2 if wrong else int(failed > 0)


def _seed(text: str) -> int:
    if not (text.isascii() and text.isdecimal()):
        raise argparse.ArgumentTypeError(f"'{text}' is not a seed; use a whole number from 0")
    return int(text)


def _said(error: ScenarioError | OSError, file: Path) -> str:
    if isinstance(error, FileNotFoundError):
        near = get_close_matches(file.name.removesuffix(".yaml"), [each.stem for each in BOOK.glob("*.yaml")], 1)
        return f"{file}: there is no such scenario" + (f"; did you mean '{near[0]}'?" if near else "")
    return f"{file}: {error.strerror}" if isinstance(error, OSError) else str(error)


if __name__ == "__main__":
    sys.exit(main())
