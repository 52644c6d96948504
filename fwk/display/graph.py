"""The graph of a system: its components by stage, and the channels between them; as text and as mermaid."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from typing import Any

from fwk.model.plan import Plan

CONTINUOUS = "continuous"
"""Column of the components that iterate at a rate of their own."""
OUTSIDE = "outside"
"""Column of the writers that are not components."""
_QUOTED = str.maketrans({'"': "#quot;", "<": "#lt;", ">": "#gt;"})


@dataclass(frozen=True)
class Node:
    """A component, or a writer outside the run."""

    name: str
    column: str
    """Its first stage, `CONTINUOUS` or `OUTSIDE`."""
    state: str = ""
    """State in a run; empty: from a launch file."""


@dataclass(frozen=True)
class Edge:
    """A channel from its writer to one of its readers."""

    writer: str
    reader: str
    channel: str
    type_name: str
    rate_hz: float | None = None
    """Messages in a second of wall time; None: from a launch file."""

    @property
    def label(self) -> str:
        """The channel, with its rate if that is known."""
        return self.channel if self.rate_hz is None else f"{self.channel} {self.rate_hz:.1f} Hz"


@dataclass(frozen=True)
class Graph:
    """Components in columns, in the order of the stages, and the channels between them."""

    name: str
    columns: tuple[str, ...]
    nodes: tuple[Node, ...]
    edges: tuple[Edge, ...]
    unread: tuple[Edge, ...] = ()
    """Channels that have a writer and no reader; their `reader` is empty."""
    unwritten: tuple[Edge, ...] = ()
    """Channels that have readers and no writer; their `writer` is empty."""

    def around(self, patterns: Sequence[str]) -> "Graph":
        """Returns the part with these components and those that exchange messages with them."""
        chosen = {each.name for each in self.nodes if any(fnmatchcase(each.name, pattern) for pattern in patterns)}
        edges = tuple(each for each in self.edges if each.writer in chosen or each.reader in chosen)
        shown = chosen.union(*((each.writer, each.reader) for each in edges))
        nodes = tuple(each for each in self.nodes if each.name in shown)
        unread = tuple(each for each in self.unread if each.writer in chosen)
        unwritten = tuple(each for each in self.unwritten if each.reader in chosen)
        return replace(self, nodes=nodes, edges=edges, unread=unread, unwritten=unwritten)._tidy()

    def column(self, name: str) -> list[Node]:
        """Returns the nodes of a column."""
        return [each for each in self.nodes if each.column == name]

    def loose_ends(self, name: str) -> list[str]:
        """Returns a line for each channel of a node that has no reader or no writer."""
        read = [f"<- {each.label} (no writer)" for each in self.unwritten if each.reader == name]
        return [*read, *(f"-> {each.label} (no reader)" for each in self.unread if each.writer == name)]

    def lines(self) -> Iterator[str]:
        """Yields text: each column with its nodes, and for each node the channels that it reads and writes."""
        for column in self.columns:
            yield f"{column}:"
            for node in self.column(column):
                yield f"  {node.name}{f' ({node.state})' if node.state else ''}"
                read = dict.fromkeys(
                    f"{each.label} from {each.writer}" for each in self.edges if each.reader == node.name
                )
                written = dict.fromkeys(each.label for each in self.edges if each.writer == node.name)
                yield from (f"    <- {each}" for each in read)
                yield from (f"    -> {each}" for each in written)
                yield from (f"    {each}" for each in self.loose_ends(node.name))

    def mermaid(self) -> Iterator[str]:
        """Yields a flowchart in the language of mermaid, with a subgraph for each column."""
        numbers = {node.name: f"n{number}" for number, node in enumerate(self.nodes)}
        yield "flowchart LR"
        for place, column in enumerate(self.columns):
            yield f'  subgraph s{place}["{column}"]'
            yield from (f'    {numbers[node.name]}["{_mermaid(node.name)}"]' for node in self.column(column))
            yield "  end"
        for edge in self.edges:
            yield f'  {numbers[edge.writer]} -->|"{_mermaid(edge.label)}"| {numbers[edge.reader]}'
        for number, edge in enumerate(self.unread):
            yield f'  {numbers[edge.writer]} -.- e{number}(["{_mermaid(edge.label)}"])'
        for number, edge in enumerate(self.unwritten, len(self.unread)):
            yield f'  e{number}(["{_mermaid(edge.label)}"]) -.- {numbers[edge.reader]}'

    def _tidy(self) -> "Graph":
        """Returns the graph without columns that have no node."""
        used = {node.column for node in self.nodes}
        return replace(self, columns=tuple(each for each in self.columns if each in used))


def graph_of(plan: Plan) -> Graph:
    """Returns the graph of a plan."""
    components = [
        {"name": each.name, "stages": [plan.stages[index] for index in each.stages], "state": ""}
        for each in plan.components
    ]
    return graph(plan.name, plan.stages, components, channel_rows(plan))


def channel_rows(plan: Plan) -> list[dict[str, Any]]:
    """Returns `channel`, `type`, `writer` and `readers` of each channel of a plan."""
    return [
        {
            "channel": each.name,
            "type": each.type_name,
            "writer": plan.writer_of(each),
            "readers": [plan.components[index].name for index in each.readers],
        }
        for each in plan.channels
    ]


def graph(
    name: str, stages: Sequence[str], components: Sequence[Mapping[str, Any]], channels: Sequence[Mapping[str, Any]]
) -> Graph:
    """Returns the graph of a system.

    Args:
        name: the system.
        stages: all stages, in their order.
        components: `name`, `stages` and `state` of each, as in the reply of a run to `status`.
        channels: `channel`, `type`, `writer`, `readers` and perhaps `rate_hz` of each.
    """
    nodes = {each["name"]: Node(each["name"], (*each["stages"], CONTINUOUS)[0], each["state"]) for each in components}
    edges = []
    unread = [
        Edge(row["writer"], "", row["channel"], row["type"], row.get("rate_hz"))
        for row in channels
        if row["writer"] and not row["readers"]
    ]
    for edge in unread:
        nodes.setdefault(edge.writer, Node(edge.writer, OUTSIDE))
    unwritten = [
        Edge("", reader, row["channel"], row["type"], row.get("rate_hz"))
        for row in channels
        for reader in row["readers"]
        if not row["writer"]
    ]
    for row in channels:
        for reader in row["readers"] if row["writer"] else ():
            nodes.setdefault(row["writer"], Node(row["writer"], OUTSIDE))
            edges.append(Edge(row["writer"], reader, row["channel"], row["type"], row.get("rate_hz")))
    columns = OUTSIDE, *stages, CONTINUOUS
    return Graph(name, columns, tuple(nodes.values()), tuple(edges), tuple(unread), tuple(unwritten))._tidy()


def _mermaid(text: str) -> str:
    return text.translate(_QUOTED)
