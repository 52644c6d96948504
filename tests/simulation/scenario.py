"""A scenario: everything that determines one history; drawn from a seed, small enough to shrink, print and keep."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from random import Random
from typing import Any, Literal

from fwk.model.plan import NOBODY, Plan
from fwk.model.sections import RestartPolicy
from fwk.testing.plans import plan_of
from tests.simulation.components import CALLS, KINDS, STAGES
from tests.simulation.faults import OUTSIDE, Action, Weather, weather_of

Hosting = Literal["process", "robot", "single", "mixed"]
Settings = dict[str, str | int | float | bool]


MANY = 400
"""More messages of an iteration than a writer keeps for readers that lose them."""


@dataclass(frozen=True)
class Part:
    """A component of a scenario."""

    name: str
    kind: str
    stages: tuple[str, ...] = ("think",)
    """Nothing: a continuous component."""
    settings: Settings = field(default_factory=dict)
    turns: tuple[int, int] = (1, 0)
    """`every` and `offset`."""


@dataclass(frozen=True)
class Scenario:
    """The events of one history."""

    seed: int
    ticks: int
    parts: tuple[Part, ...]
    stages: tuple[str, ...] = STAGES
    hosting: Hosting = "process"
    wall: bool = False
    """Real time instead of lockstep."""
    period_us: int = 50_000
    stage_time_us: int = 0
    weather: Weather = field(default_factory=Weather)
    actions: tuple[Action, ...] = ()

    @property
    def exact(self) -> bool:
        """Whether the contract promises the same bytes as without faults: an undisturbed run in lockstep."""
        continuous = any(not part.stages for part in self.parts)
        return not (self.wall or continuous or any(action.kind in OUTSIDE for action in self.actions))

    @property
    def regroupable(self) -> bool:
        """Whether the contract promises the same bytes for every assignment of components to processes."""
        apart = any(part.kind == "Director" or part.settings.get("crash_tick") for part in self.parts)
        return self.exact and not apart

    @property
    def may_fail(self) -> bool:
        """Whether a component may fail for good: by itself, or by repeated kills."""
        crashes = any(part.settings.get("crash_tick") for part in self.parts)
        return crashes or any(action.kind in ("kill", "kill_at_send", "cut_off") for action in self.actions)

    def calm(self) -> "Scenario":
        """Returns the same scenario without faults."""
        return dataclasses.replace(self, weather=Weather(), actions=())

    def plan(self) -> Plan:
        """Returns the plan that runs."""
        names = [part.name for part in self.parts]
        plan = plan_of(
            {part.name: KINDS[part.kind] for part in self.parts},
            {part.name: part.settings for part in self.parts},
            groups=groups_of(names, self.hosting, self.seed),
            period_s=self.period_us / 1e6,
            stages=self.stages,
            turns={part.name: part.turns for part in self.parts},
            restart=RestartPolicy(backoff_s=0.05, limit=3),
            clock="wall" if self.wall else "simulated",
            seed=self.seed,
            speed=1.0 if self.wall else 0.0,
            stage_time_us=self.stage_time_us,
            outside={CALLS: "simulation.call_t"} if any(part.kind == "Listener" for part in self.parts) else {},
        )
        components = [
            dataclasses.replace(
                component,
                stages=tuple(self.stages.index(stage) for stage in part.stages),
                module="tests.simulation.components",
            )
            for component, part in zip(plan.components, self.parts, strict=True)
        ]
        return dataclasses.replace(plan, components=tuple(components))


def groups_of(names: list[str], hosting: Hosting, seed: int) -> list[list[str]]:
    """Returns which components share a process; continuous ones never do."""
    together = [name for name in names if not name.startswith("drift")]
    if hosting == "single":
        return [together] if len(together) > 1 else []
    if hosting == "process":
        return []
    groups: dict[str, list[str]] = {}
    random = Random(seed)
    for name in together:
        groups.setdefault(name[0] if hosting == "robot" else str(random.randrange(3)), []).append(name)
    return [group for group in groups.values() if len(group) > 1]


def scenario_of(seed: int) -> Scenario:
    """Draws a scenario."""
    random = Random(seed)
    exact = random.random() < 0.45
    wall = not exact and random.random() < 0.4
    inner = [stage for stage in STAGES if stage == "think" or random.random() < 0.5]
    parts = _in_turns(Random(f"turns {seed}"), _parts(random, tuple(inner), exact))
    parts = _failing_again(Random(f"again {seed}"), parts, tuple(inner))
    ticks = random.choice([3, 6, 6, 10, 10, 16, 30])
    hosting = random.choice(["process", "process", "process", "robot", "single", "mixed"])
    weather = weather_of(random) if random.random() < 0.9 else Weather()
    actions = _cut_off(Random(f"cut off {seed}"), _actions(random, parts, ticks, exact))
    return Scenario(
        seed=seed,
        ticks=ticks,
        parts=parts,
        stages=tuple(inner),
        hosting=hosting,  # type: ignore[arg-type]  # one of these literals
        wall=wall,
        period_us=random.choice([10_000, 50_000]),
        stage_time_us=random.choice([0, 5_000]) if wall else 0,
        weather=weather,
        actions=actions,
    )


def _parts(random: Random, stages: tuple[str, ...], exact: bool) -> tuple[Part, ...]:
    kinds = ["Player"] * random.randint(1, 2)
    if random.random() < 0.4:
        kinds += ["Boss"] * random.randint(1, 2) + ["Worker"]
    for kind, rate, most in (("Conductor", 0.3, 1), ("Usurper", 0.3, 2), ("Director", 0.25, 1), ("Opener", 0.35, 3)):
        if random.random() < rate:
            kinds += [kind] * random.randint(1, most)
    if not exact:
        for kind, rate in (("Drifter", 0.35), ("Rover", 0.25), ("Listener", 0.3)):
            kinds += [kind] * (random.random() < rate)
    random.shuffle(kinds)
    crashes = random.random() < 0.25
    parts = []
    for number, kind in enumerate(kinds):
        continuous = not KINDS[kind].stage
        namespace = f"drift{number}" if continuous else f"{'abc'[random.randrange(3)]}{number}"
        name = f"{namespace}/{kind.lower()}"
        chosen = sorted(random.sample(range(len(stages)), random.choice([1, 1, 1, 2]) if len(stages) > 1 else 1))
        settings = _settings(random, crashes and random.random() < 0.3)
        if kind == "Rover":
            settings["work_us"] = random.choice([0, 30_000, 100_000])  # ticks pass during an iteration
        running = () if continuous else tuple(stages[place] for place in chosen)
        parts.append(Part(name, kind, running, settings))
    return tuple(parts)


def _in_turns(random: Random, parts: tuple[Part, ...]) -> tuple[Part, ...]:
    """Lets some components iterate in every k-th tick; a time source and continuous components cannot."""
    can = [part.stages and part.kind != "Conductor" and random.random() < 0.2 for part in parts]
    turns = [(random.choice([2, 2, 3, 5, 20]), random.randrange(6)) for _ in parts]
    return tuple(
        dataclasses.replace(part, turns=turn) if may else part
        for part, may, turn in zip(parts, can, turns, strict=True)
    )


def _failing_again(random: Random, parts: tuple[Part, ...], stages: tuple[str, ...]) -> tuple[Part, ...]:
    """Lets some components fail in the second iteration of a tick, when processes may lack messages of the first."""
    made = []
    for part in parts:
        if part.settings.get("crash_in") == "loop" and part.stages and len(stages) > 1 and random.random() < 0.5:
            two = tuple(stages[place] for place in sorted(random.sample(range(len(stages)), 2)))
            part = dataclasses.replace(part, stages=two, settings={**part.settings, "crash_in": "again"})
        made.append(part)
    return tuple(made)


def _settings(random: Random, crashes: bool) -> Settings:
    made: Settings = {
        "bursts": random.choice([0, 1, 3, MANY if random.random() < 0.02 else 3]),
        "ballast": random.choice([0, 20, 20, 20, 200_000 if random.random() < 0.2 else 20]),
        "work_us": random.choice([0, 0, 500, 20_000 if random.random() < 0.3 else 0]),
        "eager": random.choice([0.1, 0.3, 0.8]),
        "early": random.random() < 0.2,
    }
    if crashes:
        made["crash_tick"] = random.randint(1, 8)
        made["crash_in"] = random.choice(["loop", "loop", "init", "finalize"])
    return made


def _actions(random: Random, parts: tuple[Part, ...], ticks: int, exact: bool) -> tuple[Action, ...]:
    kinds = ["stop", "stop_at_send", "jump"]
    if not exact:
        kinds += ["kill", "kill_at_send", "kill_at_send", "set", "set", "steer", "steer", "pause"]
        kinds += ["call"] * any(part.kind == "Listener" for part in parts)
    kinds = [kind for kind in kinds if random.random() < 0.6]
    names = [part.name for part in parts]
    made = []
    for _ in range(random.choice([0, 1, 2, 4, 8]) if kinds else 0):
        kind: Any = random.choice(kinds)
        amounts: Mapping[str, int] = {
            "kill_at_send": random.randint(1, 12),
            "set": random.randint(1, 1_000_000),
            "stop": int(3_000_000 * random.random() ** 3),
            "stop_at_send": int(3_000_000 * random.random() ** 3),
            "jump": int(5_000_000 * random.random() ** 2),
            "pause": random.randint(1_000, 500_000),
            "call": random.randint(1, 1_000_000),
        }
        target = random.choice(names)
        if kind in ("stop", "stop_at_send") and random.random() < 0.3:
            target = random.choice(["supervisor", "gateway"])
        word = random.choice(["start", "stop", "restart", "restart", "load", "unload"]) if kind == "steer" else ""
        delay_us = int(20_000 * random.random() ** 2)
        amount = amounts.get(kind, 0)
        made.append(Action(kind, random.randint(0, max(0, ticks - 1)), delay_us, target, amount, word))
    return tuple(sorted(made, key=lambda action: (action.after_tick, action.delay_us)))


def _cut_off(random: Random, actions: tuple[Action, ...]) -> tuple[Action, ...]:
    """Lets some of the processes that end while they send lose the network first."""
    return tuple(
        dataclasses.replace(action, kind="cut_off", amount=random.randint(3, 30))
        if action.kind == "kill_at_send" and random.random() < 0.5
        else action
        for action in actions
    )


def writers_of(plan: Plan) -> dict[str, str]:
    """Returns the writer of each channel of a plan."""
    return {channel.name: plan.components[channel.writer].name for channel in plan.channels if channel.writer != NOBODY}
