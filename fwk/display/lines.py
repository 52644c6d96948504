"""Lines of text for people: log lines, and the state of a run in one line."""

from datetime import UTC, datetime

from fwk.clock import US_PER_S
from fwk.component.log import LEVEL_NAMES
from fwk.display import figures
from lcmtypes.core import log_t, status_t


def log_line(line: log_t) -> str:
    """Returns wall time, tick, logical time, level, component, text and place in the source."""
    wall = datetime.fromtimestamp(line.wall_us / US_PER_S, UTC).astimezone().strftime("%H:%M:%S.%f")[:-3]
    level = LEVEL_NAMES.get(line.level, str(line.level))
    return (
        f"{wall} {line.tick:>6} {line.time_us / US_PER_S:9.3f} s {level:7} {line.component}: {line.text} "
        f"({line.file}:{line.line})"
    )


def held_back_line(line: log_t, count: int) -> str:
    """Returns the line that replaces equivalent lines that were not printed."""
    level = LEVEL_NAMES.get(line.level, str(line.level))
    first = line.text.partition("\n")[0]
    return f"... {count} more {level} {'line' if count == 1 else 'lines'} like: {line.component}: {first}"


def status_line(status: status_t) -> str:
    """Returns tick, logical time, pace, states and losses so far."""
    return (
        f"tick {status.tick}   {status.time_us / US_PER_S:.2f} s   {pace(status)}   "
        f"{status.ticks_per_s:.1f} ticks/s   {_states(status)}   {losses(status)}"
    )


def progress_of(status: status_t) -> str:
    """Returns a text that differs between two statuses when the run has advanced or a state has changed."""
    return f"{status.tick} {_states(status)}"


def _states(status: status_t) -> str:
    return ", ".join(f"{count} {state}" for state, count in figures.states(figures.components(status)).items())


def pace(status: status_t) -> str:
    """Returns how fast logical time advances."""
    return "paused" if status.paused else f"speed {status.speed:.2f}"


def losses(status: status_t) -> str:
    """Returns the numbers of lost messages and late iterations; if there are any, also of messages fetched again,
    datagrams refused, repeated ticks and restarts.
    """
    sums = figures.totals(status)
    always = {"lost": sums.lost, "late": status.late}
    others = {
        "fetched": sums.fetched,
        "refused": sums.foreign,
        "repeated": status.repeated,
        "restarts": figures.restarts(status),
    }
    shown = {**always, **{word: count for word, count in others.items() if count}}
    return "   ".join(f"{word} {count}" for word, count in shown.items())
