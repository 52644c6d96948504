"""Plans, statuses and log lines like those of a run."""

from collections.abc import Sequence

from fwk.model.plan import ChannelPlan, Plan
from lcmtypes.core import component_state_t, host_status_t, log_t, status_t
from lcmtypes.soccer import game_state_t

ROBOT = [
    "base",
    "kicker",
    "camera",
    "omni_ball",
    "omni_field",
    "localization",
    "world_model",
    "navigator",
    "skiller",
    "agent",
]
MATCH = [
    "world/simulator",
    "world/referee",
    *(f"{team}{number}/{own}" for team in ("cyan", "magenta") for number in range(1, 6) for own in ROBOT),
    "team_cyan/radio",
    "team_magenta/radio",
]
TRACKER = ["cyan1/camera", "cyan1/tracker"]


def plan(scoreboard: str = "") -> Plan:
    """A plan of which the display needs the name, the scoreboard and one channel."""
    channels = (ChannelPlan(0, "world/game_state", "soccer.game_state_t", 0, ()),)
    return Plan(
        "match", "launch/match.yaml", (), ("think",), 50_000, "simulated", 1, (), channels, (), scoreboard=scoreboard
    )


def headline(newest: object) -> str:
    """A scoreboard of the newest game state."""
    state = newest("world/game_state")  # type: ignore[operator]
    return f"CYAN {state.score_cyan} : {state.score_magenta} MAGENTA" if state else "no score yet"


def game_state(cyan: int, magenta: int) -> game_state_t:
    """Returns a game state with a score."""
    state = game_state_t()
    state.score_cyan, state.score_magenta = cyan, magenta
    return state


def status(names: Sequence[str], tick: int, busy_us: int = 1000, **changes: object) -> status_t:
    """A status: all components running, a process each, every iteration `busy_us` long; `changes` are fields of it."""
    made = status_t()
    made.tick, made.time_us, made.speed, made.ticks_per_s = tick, tick * 50_000, 1.0, 20.0
    for index, name in enumerate(names):
        host, component = host_status_t(), component_state_t()
        host.host, host.state = index, "running"
        component.name, component.state, component.iterations = name, "running", tick
        component.busy_us, component.worst_us = tick * busy_us, 2 * busy_us
        host.n, host.components = 1, [component]
        made.hosts.append(host)
    made.n = len(made.hosts)
    for field, value in changes.items():
        setattr(made, field, value)
    return made


def component(of: status_t, name: str) -> component_state_t:
    """Returns one component of a status, to be changed."""
    return next(each for host in of.hosts for each in host.components if each.name == name)


def host_of(of: status_t, name: str) -> host_status_t:
    """Returns the host of a component of a status, to be changed."""
    return next(host for host in of.hosts if any(each.name == name for each in host.components))


def log(text: str, level: int = log_t.INFO) -> log_t:
    """Returns a log line of cyan1/tracker."""
    line = log_t()
    line.level, line.component, line.text = level, "cyan1/tracker", text
    line.tick, line.time_us, line.file, line.line = 40, 2_000_000, "tracker.py", 12
    return line


def packet(channel: str, message: status_t | log_t | game_state_t) -> bytes:
    """Returns a packet of the supervisor for the display."""
    return channel.encode() + b"\0" + message.encode()
