"""Draws series of a log as PNG or SVG: one diagram for each unit, over the same time."""

from collections.abc import Sequence
from pathlib import Path

from matplotlib import rc_context
from matplotlib.figure import Figure

from fwk.clock import US_PER_S
from fwk.log_tools.series import Series
from fwk.recording.log_contents import Note

_WIDTH_IN, _HEIGHT_IN = 10.0, 3.2
_STEP_VALUES = 12
"""Series of at most so many different whole numbers are drawn as steps: states, counts, truth values."""


def draw(series: Sequence[Series], notes: Sequence[Note], out: Path, form: str, title: str) -> None:
    """Draws series to a file; bookmarks are vertical lines. The same series give the same file.

    Args:
        series: what is drawn.
        notes: bookmarks; times as in the series.
        out: the file.
        form: `png` or `svg`.
        title: title of the drawing.
    """
    units = list(dict.fromkeys(each.unit for each in series))
    figure = Figure(figsize=(_WIDTH_IN, _HEIGHT_IN * len(units)), layout="constrained")
    axes = figure.subplots(len(units), sharex=True, squeeze=False)[:, 0]
    axes[0].set_title(title)
    for axis, unit in zip(axes, units, strict=True):
        for each in series:
            if each.unit == unit:
                style = "steps-post" if _is_state(each) else "default"
                axis.plot(each.times_s, each.values, label=each.label, drawstyle=style, linewidth=1.2)
        for note in notes:
            axis.axvline(note.time_us / US_PER_S, color="grey", linestyle="--", linewidth=0.8)
        axis.set_ylabel(unit)
        axis.grid(visible=True, alpha=0.3)
        axis.legend(loc="best", fontsize="small")
    for note in notes:
        axes[0].annotate(
            note.text, (note.time_us / US_PER_S, 1), xycoords=("data", "axes fraction"), fontsize="x-small"
        )
    axes[-1].set_xlabel("s")
    with rc_context({"svg.hashsalt": "fwk"}):
        figure.savefig(out, format=form, metadata={"Date": None} if form == "svg" else {})


def _is_state(series: Series) -> bool:
    different = set(series.values)
    return len(different) <= _STEP_VALUES and all(value.is_integer() for value in different)
