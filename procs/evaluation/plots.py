"""Pictures of a table: each measure with its interval."""

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path

import numpy as np

from procs.evaluation.table import Row


def plot(rows: Sequence[Row], file: Path) -> None:
    """Draws the measures that have a finite value, with the finite limits, a panel for each unit, as PNG.

    Raises:
        ImportError: matplotlib is not installed.
    """
    from matplotlib.figure import Figure  # takes half a second, which each start of a match would pay, too

    known = sorted((row for row in rows if np.isfinite(row.value)), key=lambda row: row.unit)
    panels = [list(group) for _, group in groupby(known, key=lambda row: row.unit)]
    if not panels:
        return
    figure = Figure(figsize=(8, 1.2 + 0.32 * (len(known) + len(panels))), layout="constrained")
    axes = figure.subplots(len(panels), 1, squeeze=False, height_ratios=[len(panel) for panel in panels])
    for axis, panel in zip(axes[:, 0], panels, strict=True):
        places = range(len(panel))
        lows = [row.value - row.low if np.isfinite(row.low) else 0.0 for row in panel]
        highs = [row.high - row.value if np.isfinite(row.high) else 0.0 for row in panel]
        errors = np.maximum(0.0, (lows, highs))
        axis.errorbar([row.value for row in panel], places, xerr=errors, fmt="o", capsize=3)
        axis.set_yticks(places, [row.name for row in panel])
        axis.set_ylim(len(panel) - 0.5, -0.5)
        axis.set_xlabel(panel[0].unit or "ratio")
        axis.grid(axis="x", alpha=0.4)
    figure.savefig(file, dpi=100)
