"""An evaluation that measures nothing but its own arguments, of a component that does nothing."""

import os
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from fwk import Component


class Idle(Component):
    """Does nothing."""

    stage = "act"

    def loop(self) -> None:
        """Ends at once."""


def measured(file: str, time_s: float, seed: int, sets: Sequence[str] = ()) -> dict[str, Any]:
    """Returns the arguments and the number of the process; seed 13 fails, 66 dies, 77 exits, and 88 hangs."""
    if seed == 13:
        raise ValueError("an unlucky seed")
    if seed == 66:
        os._exit(1)
    if seed == 77:
        sys.exit("no more")
    if seed == 88:
        signal.pause()
    return {"time_s": time_s, "seed": seed, "process": os.getpid(), "sets": list(sets)}


def without_settings(file: str, time_s: float, seed: int) -> dict[str, Any]:
    """Measures as an evaluation without settings."""
    return measured(file, time_s, seed)


def report(results: Sequence[dict[str, Any]], folder: Path) -> str:
    """Returns the seeds, and writes them down."""
    text = " ".join(str(result["seed"]) for result in results)
    (folder / "seeds.txt").write_text(text)
    return text
