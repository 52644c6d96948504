"""Draws series as text for a terminal: one diagram for each unit, over the same time."""

from collections.abc import Sequence

import plotext

from fwk.clock import US_PER_S
from fwk.log_tools.series import Series
from fwk.recording.log_contents import Note

_LEAST_ROWS = 8


def drawn(series: Sequence[Series], notes: Sequence[Note], columns: int, rows: int, colours: bool) -> str:
    """Returns a drawing; bookmarks are vertical lines.

    Args:
        series: what is drawn.
        notes: bookmarks; times as in the series.
        columns: width in characters.
        rows: height in lines; a diagram has at least 8.
        colours: whether the text has the sequences of a terminal with colours.
    """
    units = list(dict.fromkeys(each.unit for each in series))
    figure = plotext.figure
    figure.clear()
    if len(units) > 1:
        figure.subplots(len(units), 1)
    figure.plot_size(columns, max(rows, _LEAST_ROWS * len(units)))
    for place, unit in enumerate(units, 1):
        diagram = figure if len(units) == 1 else figure.subplot(place, 1)
        diagram.theme("simple")
        for each in series:
            if each.unit == unit and each.values:
                signal = diagram.signal(each.times_s, each.values, marker="braille")
                signal.lines().label(f"{each.label} {each.values[-1]:.6g}")
                diagram.draw(signal)
        for note in notes:
            diagram.line(note.time_us / US_PER_S, orientation=1)
        diagram.label(" ".join(filter(None, (f"[{unit}]" if unit else "", "over s"))), "x")
    text = str(figure.build())
    return text if colours else str(plotext.uncolorize(text))
