"""The graph of a system as an SVG drawing: a column for each stage, the channels as curves from left to right."""

from collections.abc import Iterator
from xml.sax.saxutils import escape, quoteattr

from fwk.display.graph import Edge, Graph

_COLUMN, _ROW, _HEIGHT, _MARGIN, _HEAD = 250, 34, 22, 20, 44
"""Distances in pixels: from column to column, from row to row, height of a box, around the drawing, above the boxes."""
_LINE = 10
"""Height of a line about a channel without reader or writer, below the box of its component."""
_DEPTH = 160
"""Height below the boxes for the curves from right to left."""
_LETTER, _PADDING = 6.3, 14
_LABELS_MAX = 60
"""Most curves whose rates are written beside them; those of more curves would lie upon each other."""
_STYLE = (
    "svg{background:#fff}text{font:11px sans-serif;fill:#222}.head{font-weight:bold}rect{fill:#eef3fb;stroke:#5b7db1}"
    ".running rect{fill:#e6f5ea;stroke:#3f9b5a}.failed rect{fill:#fbe3e3;stroke:#b04a4a}"
    ".stopped rect,.loaded rect{fill:#eee;stroke:#999}.late rect,.held rect{fill:#fff1dc;stroke:#c07a10}"
    ".loose{font-size:8px;fill:#777}.rate{font-size:9px;fill:#555;text-anchor:middle}"
    ".back{stroke-dasharray:4 3}path{fill:none;stroke:#7a7a7a;stroke-opacity:.55}"
    "path:hover{stroke:#d05010;stroke-opacity:1;stroke-width:2}"
)


def svg(graph: Graph) -> str:
    """Returns the drawing; each curve has a tooltip with its channels, types and rates.

    Channels without reader or writer are named below the box of their component. Up to sixty curves have
    their rates beside them.
    """
    places: dict[str, tuple[int, int]] = {}
    floor = _HEAD
    for number, column in enumerate(graph.columns):
        y = _HEAD
        for node in graph.column(column):
            places[node.name] = _MARGIN + number * _COLUMN, y
            y += _ROW + _LINE * len(graph.loose_ends(node.name))
        floor = max(floor, y)
    width, height = 2 * _MARGIN + _COLUMN * len(graph.columns), floor + _DEPTH
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}">',
        f"<title>{escape(graph.name)}</title><style>{_STYLE}</style>",
        *_curves(graph, places, floor),
        *_boxes(graph, places),
        "</svg>",
    ]
    return "\n".join(lines) + "\n"


def _curves(graph: Graph, places: dict[str, tuple[int, int]], floor: int) -> Iterator[str]:
    channels: dict[tuple[str, str], list[Edge]] = {}
    for edge in graph.edges:
        channels.setdefault((edge.writer, edge.reader), []).append(edge)
    widths = {node.name: _width(node.name) for node in graph.nodes}
    for (writer, reader), edges in channels.items():
        (x0, y0), (x1, y1) = places[writer], places[reader]
        if x0 < x1:
            begin, bend = x0 + widths[writer], (x1 - x0) // 2
            y0, y1 = y0 + _HEIGHT // 2, y1 + _HEIGHT // 2
            path = f'd="M{begin:g},{y0} C{begin + bend:g},{y0} {x1 - bend},{y1} {x1},{y1}"'
            middle = (begin + x1) / 2, (y0 + y1) / 2
        else:  # back, or to a later tick in the same stage: below all boxes
            begin, end = x0 + widths[writer] / 2, x1 + widths[reader] / 2
            depth = floor + _DEPTH * (x0 - x1) / (_COLUMN * len(graph.columns))
            y0, y1 = y0 + _HEIGHT, y1 + _HEIGHT
            path = f'class="back" d="M{begin:g},{y0} C{begin:g},{depth:g} {end:g},{depth:g} {end:g},{y1}"'
            middle = (begin + end) / 2, (y0 + y1 + 6 * depth) / 8
        labels = ", ".join(f"{each.label} ({each.type_name})" for each in edges)
        yield f"<path {path}><title>{escape(f'{writer} to {reader}: {labels}')}</title></path>"
        if rate := _rate(edges) if len(channels) <= _LABELS_MAX else "":
            yield f'<text class="rate" x="{middle[0]:g}" y="{middle[1] - 3:g}">{escape(rate)}</text>'


def _rate(edges: list[Edge]) -> str:
    """Returns the rate of the channels from one component to another; empty if the rates are not known."""
    rates_hz = [each.rate_hz for each in edges if each.rate_hz is not None]
    if not rates_hz:
        return ""
    name = edges[0].channel.rpartition("/")[2] if len(edges) == 1 else f"{len(edges)} channels,"
    return f"{name} {sum(rates_hz):.1f} Hz"


def _boxes(graph: Graph, places: dict[str, tuple[int, int]]) -> Iterator[str]:
    for number, column in enumerate(graph.columns):
        yield f'<text class="head" x="{_MARGIN + number * _COLUMN}" y="{_HEAD - 18}">{escape(column)}</text>'
        for node in graph.column(column):
            x, y = places[node.name]
            yield (
                f"<g class={quoteattr(node.state or 'planned')}>"
                f'<rect x="{x}" y="{y}" width="{_width(node.name):g}" height="{_HEIGHT}" rx="4"/>'
                f'<text x="{x + _PADDING // 2}" y="{y + 15}">{escape(node.name)}</text></g>'
            )
            for line, text in enumerate(graph.loose_ends(node.name), start=1):
                yield f'<text class="loose" x="{x}" y="{y + _HEIGHT + line * _LINE}">{escape(text)}</text>'


def _width(name: str) -> float:
    return round(len(name) * _LETTER + _PADDING, 1)
