"""Draws a view of the run as text: headline, figures, components beside a drawing, problems, log lines, keys."""

from itertools import groupby

from rich.console import Group, RenderableType
from rich.panel import Panel
from rich.text import Text

from fwk.clock import US_PER_S
from fwk.component.log import LEVEL_NAMES
from fwk.display import figures
from fwk.display.floods import LineGroup
from fwk.display.lines import losses, pace
from fwk.display.table import Column, Table, cells, wrapped
from fwk.display.view import LEVELS, View
from lcmtypes.core import component_state_t, status_t

_STATE_STYLES = {"running": "", "failed": "red", "late": "yellow", "held": "yellow", "stopped": "dim"}
_LEVEL_STYLES = {"debug": "dim", "info": "", "warning": "yellow", "error": "bold red"}
_GAP = "   "
_FRAME_ROWS = 6  # headline with its frame, figures, keys, one row for the cursor
_LEAST_LOG_ROWS = 3
_DRAWING_LEAST = (26, 9)  # columns and rows
_DRAWING_MOST = (96, 34)
_DRAWING_SHARE = 0.44  # of the width
KEYS = ("space pause", "s step", "+/- speed", "m max", "tab component", "l level", "esc all", "q quit")


def screen(view: View, rows: int, columns: int = 120, keys: bool = False) -> RenderableType:
    """Returns the whole picture for a terminal of that size; it is one row lower."""
    headline = view.headline
    words = Text(headline or view.plan.name, justify="center", style="bold", no_wrap=True)
    parts: list[RenderableType] = [Panel(words, title=view.plan.name if headline else None)]
    room = rows - _FRAME_ROWS
    status = view.status
    if status is None:
        parts.append(Text("starting ...", style="dim"))
    else:
        worries = _worries(view, status, columns)[: max(1, rows // 8)]
        room -= len(worries) + _LEAST_LOG_ROWS
        body = _body(view, status, columns, room)
        parts += [*_figures(view, status, columns), *body, *worries]
        room += _LEAST_LOG_ROWS - len(body)
    parts += _log_rows(view, columns, max(_LEAST_LOG_ROWS, room))
    if keys:
        parts.append(_line(_foot(view, columns), "dim", columns))
    return Group(*parts)


def _figures(view: View, status: status_t, columns: int) -> list[Text]:
    """Returns the line of figures, without the last ones where the terminal is too narrow for all."""
    sums = figures.totals(status)
    used = sum(view.cpu.percent.values())
    parts = [f"tick {status.tick}", f"{status.time_us / US_PER_S:.2f} s", pace(status)]
    parts += [f"{status.ticks_per_s:.1f} ticks/s", *([f"CPU {used:.0f} %"] if used else [])]
    text = Text(" " + _GAP.join(parts), no_wrap=True)
    style = "yellow" if sums.lost or status.late else "dim"
    for part in losses(status).split(_GAP):
        if text.cell_len + len(_GAP) + cells(part) < columns:
            text.append(_GAP + part, style=style)
    return [text]


def _body(view: View, status: status_t, columns: int, room: int) -> list[Text]:
    """Returns the rows of the table, with the drawing of the scoreboard at their right if there is room for both."""
    width = min(_DRAWING_MOST[0], round(columns * _DRAWING_SHARE))
    height = min(_DRAWING_MOST[1], room)
    drawing = view.drawing(width, height) if width >= _DRAWING_LEAST[0] and height >= _DRAWING_LEAST[1] else []
    drawn = max((sum(cells(text) for text, _ in line) for line in drawing), default=0)
    left = _table(view, status, columns - drawn - 2 if drawing else columns, room)
    if not drawing:
        return left
    rows = []
    for number in range(max(len(left), len(drawing))):
        row = Text(no_wrap=True)
        row.append_text(left[number] if number < len(left) else Text())
        row.append(" " * max(0, columns - drawn - row.cell_len))
        for text, style in drawing[number] if number < len(drawing) else ():
            row.append(text, style)
        rows.append(row)
    return rows


def _table(view: View, status: status_t, width: int, room: int) -> list[Text]:
    """Returns a row for each component if there is room for all, else one for each namespace."""
    components = figures.components(status)
    table = _by_component(view, status) if len(components) < room else _by_namespace(view, status)
    lines = [line for line in table.lines(width - 1, colour=True) if not line.startswith("\x1b[2m(not shown")]
    return [Text.from_ansi(f" {line}", no_wrap=True) for line in lines]


def _by_component(view: View, status: status_t) -> Table:
    table = Table("component", "state", *_numbers(**{"CPU %": 2, "loop ms": 1, "worst ms": 3, "lost": 1}))
    times, percent = view.loop_times, view.cpu.percent
    found = [(component, host) for host in status.hosts for component in host.components]
    for component, host in sorted(found, key=lambda each: each[0].name):
        time = times[component.name]
        alone = len(host.components) == 1 and host.pid in percent
        cpu = f"{percent[host.pid]:.0f}" if alone else ""
        name = _marked(view, component.name)
        lost = figures.lost([host] if len(host.components) == 1 else [], [component])
        table.add(
            *(name, component.state, cpu, f"{time.mean_ms:.2f}", f"{time.worst_ms:.1f}", lost),
            style="bold" if component.name == view.selected else _STATE_STYLES.get(component.state, "cyan"),
        )
    return table


def _by_namespace(view: View, status: status_t) -> Table:
    ranks = {"CPU %": 2, "loop ms": 3}
    more = {"worst ms": 5, "lost": 1, "restarts": 4}
    table = Table("namespace", "components", *_numbers(**ranks), Column("slowest", rank=6), *_numbers(**more))
    times, percent = view.loop_times, view.cpu.percent
    host_of = {component.name: host for host in status.hosts for component in host.components}
    ordered = sorted(figures.components(status), key=lambda each: _split(each.name))
    for namespace, group in groupby(ordered, key=lambda each: _split(each.name)[0]):
        members = list(group)
        hosts = {host_of[member.name].host: host_of[member.name] for member in members}
        own = {member.name: times[member.name] for member in members}
        slowest = figures.slowest(own, 1)[0]
        pids = {host_of[member.name].pid for member in members} & percent.keys()
        table.add(
            _marked(view, namespace or "-"),
            ", ".join(f"{count} {state}" for state, count in figures.states(members).items()),
            f"{sum(percent[pid] for pid in pids):.0f}" if pids else "",
            f"{sum(time.mean_ms for time in own.values()):.2f}",
            f"{_split(slowest.name)[1]} {slowest.mean_ms:.2f}",
            f"{max(time.worst_ms for time in own.values()):.1f}",
            figures.lost(hosts.values(), members),
            max(host_of[member.name].restarts for member in members),
            style=_namespace_style(view, namespace, members),
        )
    return table


def _namespace_style(view: View, namespace: str, members: list[component_state_t]) -> str:
    if view.selected and view.selected.partition("/")[0] == namespace:
        return "bold"
    styles = {_STATE_STYLES.get(member.state, "cyan") for member in members}
    return next((style for style in ("red", "yellow", "cyan") if style in styles), "")


def _numbers(**ranks: int) -> list[Column]:
    return [Column(title, right=True, rank=rank) for title, rank in ranks.items()]


def _marked(view: View, name: str) -> str:
    return f"> {name}" if name == view.selected else name


def _worries(view: View, status: status_t, columns: int) -> list[Text]:
    said = view.waiting or view.slowness
    lines = [_line(f" {said}", "bold yellow" if view.waiting else "yellow", columns)] if said else []
    for component in figures.components(status):
        if component.state not in figures.WELL:
            style = _LEVEL_STYLES["error"] if component.state == "failed" else "yellow"
            text = f" {component.name} {component.state}: {component.reason or 'no reason given'}"
            lines += [_line(part, style, columns) for part in _folded(text, columns)]
    return lines


def _log_rows(view: View, columns: int, rows: int) -> list[Text]:
    """Returns the newest lines, whole, as many as fit; of the newest at least its beginning."""
    found: list[Text] = []
    for group in reversed(view.shown_lines()):
        made = _log_lines(group, columns, rows)
        if found and len(found) + len(made) > rows:
            break
        found = [*made[:rows], *found]
    return found


def _log_lines(group: LineGroup, columns: int, rows: int) -> list[Text]:
    line = group.line
    level = LEVEL_NAMES.get(line.level, "error")
    text = f" {line.time_us / US_PER_S:8.2f} {level:7} {line.component}: {group.text[: columns * rows]}"
    return [Text(part, _LEVEL_STYLES[level], no_wrap=True) for part in _folded(text, columns)]


def _folded(text: str, columns: int) -> list[str]:
    """Breaks a text of one or several lines; continuations are indented."""
    indent = " " * 18
    first, *others = text.split("\n")
    words = first.lstrip()
    margin = " " * (len(first) - len(words))
    start = wrapped(words, columns - len(margin))[:1]
    rest = words[len(start[0]) :].lstrip() if start else ""
    parts = [margin + each for each in start] + [indent + part for part in wrapped(rest, columns - len(indent))]
    for other in others:
        parts += [indent + part for part in wrapped(other.rstrip(), columns - len(indent))]
    return parts


def _foot(view: View, columns: int) -> str:
    """Returns the answer to the last key, or the filters and as many keys as fit, first those of the filters."""
    filters = [f"lines of {view.selected}"] if view.selected else []
    if view.level:
        filters.append(f"level {LEVEL_NAMES[LEVELS[view.level]]}")
    chosen = f"[{', '.join(filters)}]  " if filters else ""
    shown = list(KEYS)
    while shown and cells(chosen) + cells("  ".join(shown)) >= columns:
        del shown[0]
    return f" {view.message}" if view.message else f" {chosen}{'  '.join(shown)}"


def _line(text: str, style: str, columns: int) -> Text:
    made = Text(text, style, no_wrap=True)
    made.truncate(columns, overflow="ellipsis")
    return made


def _split(name: str) -> tuple[str, str]:
    namespace, _, own = name.rpartition("/")
    return namespace, own
