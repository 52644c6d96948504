"""Draws a view of the run as tidy text: headline, figures, one row a robot, worrying components, last log lines."""

from itertools import groupby

from rich.console import Group, RenderableType
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from fwk.clock import US_PER_S
from fwk.component.log import LEVEL_NAMES
from fwk.display import figures
from fwk.display.lines import losses, pace
from fwk.display.view import View
from lcmtypes.core import component_state_t, log_t, status_t

_STATE_STYLES = {"running": "green", "failed": "bold red", "held": "yellow", "stopped": "dim"}
_LEVEL_STYLES = {"debug": "dim", "info": "", "warning": "yellow", "error": "bold red"}
_FRAME_ROWS = 6  # headline with its frame, figures, head of the table, one row for the cursor
_LEAST_LOG_ROWS = 3


def screen(view: View, rows: int) -> RenderableType:
    """The whole picture for a terminal of `rows` lines; `Text` lines are cut at its right edge, never wrapped."""
    headline = view.headline
    words = Text(headline or view.plan.name, justify="center", style="bold", no_wrap=True)
    parts: list[RenderableType] = [Panel(words, title=view.plan.name if headline else None)]
    status = view.status
    if status is None:
        parts.append(Text("starting ...", style="dim"))
        used = 0
    else:
        worries = _worries(status)[: max(0, rows // 8)]
        room = rows - _FRAME_ROWS - _LEAST_LOG_ROWS - len(worries)
        table, used = _table(view, status, room)
        used += len(worries)
        parts += [_figures(status), table, *worries]
    lines = list(view.lines)[-max(_LEAST_LOG_ROWS, rows - _FRAME_ROWS - used) :]
    return Group(*parts, *map(_log_row, lines))


def _figures(status: status_t) -> Text:
    sums = figures.totals(figures.components(status))
    text = Text(no_wrap=True, overflow="ellipsis")
    text.append(f" tick {status.tick}   {status.time_us / US_PER_S:.2f} s   {pace(status)}   ")
    text.append(f"{status.ticks_per_s:.1f} ticks/s   ")
    clean = not sums.lost and not status.late
    text.append(losses(status), style="dim" if clean else "yellow")
    return text


def _table(view: View, status: status_t, room: int) -> tuple[Table, int]:
    """A row a component if there is room for all, else a row a namespace; with the number of rows."""
    components = figures.components(status)
    if len(components) <= room:
        return _by_component(view, components), len(components)
    return _by_namespace(view, status)


def _by_component(view: View, components: list[component_state_t]) -> Table:
    table = _empty("component", "state", "loop ms", "worst ms", "lost")
    times = view.loop_times
    for component in sorted(components, key=lambda each: each.name):
        time = times[component.name]
        state = Text(component.state, _STATE_STYLES.get(component.state, "cyan"))
        table.add_row(component.name, state, f"{time.mean_ms:.2f}", f"{time.worst_ms:.1f}", _count(component.lost))
    return table


def _by_namespace(view: View, status: status_t) -> tuple[Table, int]:
    table = _empty("namespace", "components", "loop ms", "slowest", "worst ms", "lost", "restarts")
    times = view.loop_times
    restarts = {component.name: host.restarts for host in status.hosts for component in host.components}
    ordered = sorted(figures.components(status), key=lambda each: _split(each.name))
    count = 0
    for namespace, group in groupby(ordered, key=lambda each: _split(each.name)[0]):
        members = list(group)
        sums = figures.totals(members)
        own = {member.name: times[member.name] for member in members}
        slowest = figures.slowest(own, 1)[0]
        count += 1
        table.add_row(
            namespace or "-",
            _states(sums),
            f"{sum(time.mean_ms for time in own.values()):.2f}",
            f"{_split(slowest.name)[1]} {slowest.mean_ms:.2f}",
            f"{max(time.worst_ms for time in own.values()):.1f}",
            _count(sums.lost),
            _count(max(restarts[member.name] for member in members)),
        )
    return table, count


def _empty(first: str, *others: str) -> Table:
    table = Table(box=None, pad_edge=True, header_style="dim", collapse_padding=True)
    table.add_column(first, no_wrap=True, min_width=12)
    for title in others:
        words = title in ("state", "components", "slowest")
        table.add_column(title, no_wrap=True, min_width=len(title), justify="left" if words else "right")
    return table


def _states(sums: figures.Totals) -> Text:
    return Text(", ").join(
        Text(f"{count} {state}", _STATE_STYLES.get(state, "cyan")) for state, count in sums.states.items()
    )


def _worries(status: status_t) -> list[Text]:
    return [
        Text(
            f" {component.name} {component.state}: {component.reason or 'no reason given'}",
            _STATE_STYLES.get(component.state, ""),
            no_wrap=True,
            overflow="ellipsis",
        )
        for component in figures.components(status)
        if component.state not in figures.WELL
    ]


def _log_row(line: log_t) -> Text:
    level = LEVEL_NAMES.get(line.level, "error")
    text = f" {line.time_us / US_PER_S:8.2f} {level:7} {line.component}: {line.text}"
    return Text(text.split("\n")[0], _LEVEL_STYLES[level], no_wrap=True, overflow="ellipsis")


def _split(name: str) -> tuple[str, str]:
    namespace, _, own = name.rpartition("/")
    return namespace, own


def _count(number: int) -> Text:
    return Text(str(number), "bold yellow" if number else "dim")
