"""Mistakes in a component's class that the check reports: a row each."""

from pathlib import Path

import pytest

from fwk.model.errors import PlanError
from fwk.plan.load import load_plan

HEAD = """
from fwk import Aspect, Clock, Component, Config, Each, MainLoop, Reads, Serves, TimeSource
from fwk import VisionMaster, Writes, channel
from lcmtypes.core import command_t
from lcmtypes.robot import odometry_t
class Settings(Config):
    gain: float = 1.0
class Levelled(Config):
    log_level: str = "all"
class Greedy(Aspect):
    ball: Writes[odometry_t]
class Feeds(Aspect):
    balls: Each[Writes[odometry_t]]
class Odd(Component):
    stage = "think"
"""
ROWS = {
    "stage = 5": """Odd: stage is 5; it should be text such as "think", or a tuple of texts""",
    "stage = ('think', 3)": """Odd: stage is ('think', 3); it should be text such as "think", or a tuple of texts""",
    "loop: Reads[odometry_t]": "Odd.loop: every component has 'loop'; choose another name",
    "finalize: Clock": "Odd.finalize: every component has 'finalize'; choose another name",
    "settings: Settings": "Odd.settings: the attribute for settings has to be called 'config'",
    "config: Levelled": "Odd: every component has a setting 'log_level'; choose another name",
    "ball: 'Reads[odometry_t'": "Odd: an annotation cannot be read: Forward reference must be an expression -- got "
    "'Reads[odometry_t'",
    "ball: 'Reads[ball_t]'": "Odd: an annotation cannot be read: name 'ball_t' is not defined",
    "def lop(self) -> None: ...": "Odd.lop: the framework calls no method 'lop'; did you mean 'loop'?",
    "def Finalise(self) -> None: ...": "Odd.Finalise: the framework calls no method 'Finalise'; "
    "did you mean 'finalize'?",
    "def loop(self, dt) -> None: ...": "Odd.loop: missing a required argument: 'dt'; write: def loop(self) -> None",
    "def init() -> None: ...": "Odd.init: too many positional arguments; write: def init(self) -> None",
    "def __init__(self, size): ...": "Odd.__init__: missing a required argument: 'size'; write: def __init__(self) -> "
    "None",
    "async def loop(self) -> None: ...": "Odd.loop: the framework awaits no coroutine; write: def loop(self) -> None",
    "def loop(self): yield": "Odd.loop: 'yield' makes it a generator, which the framework does not run",
    "every = 0": "Odd: every is 0; it should be a whole number from 1 to 1000000",
    "every = 2.0": "Odd: every is 2.0; it should be a whole number from 1 to 1000000",
    "offset = -1": "Odd: offset is -1; it should be a whole number from 0 to 1000000",
    "every, sun = 2, None; sun: TimeSource": "Odd: a time source iterates in each tick; leave 'every' out",
    "every, stage, rate_hz = 2, (), 5": "Odd: both 'every' and 'rate_hz'; keep one",
    "ball: Reads": "Odd.ball: Reads has no message type; write ball: Reads[message_t]",
    "way: Serves": "Odd.way: Serves has no message type; write way: Serves[command_t] or Serves[request_t, reply_t]",
    "ways: Each[Reads]": "Odd.ways: Reads has no message type; write ways: Each[Reads[message_t]]",
    "ways: Each": "Odd.ways: Each of nothing; Each is for Reads, Writes, Serves, Calls and Image, such as "
    "Each[Reads[ball_t]]",
    "ways: Each[Clock]": "Odd.ways: Each of Clock; Each is for Reads, Writes, Serves, Calls and Image, such as "
    "Each[Reads[ball_t]]",
    "ways: Each[VisionMaster]": "Odd.ways: Each of VisionMaster; Each is for Reads, Writes, Serves, Calls and Image, "
    "such as Each[Reads[ball_t]]",
    "ball: int": "Odd.ball: int is not an aspect; annotate with Reads, Writes, Serves, Calls, Image, Each, "
    "VisionMaster, a Config, Clock, Logger, LogLines, numpy.random.Generator, TimeSource, MainLoop, "
    "PluginControl, Blackboard or an Aspect, and set plain attributes in init()",
    "ball: Reads[int]": "Odd.ball: <class 'int'> is not an LCM type; import one from lcmtypes",
    "ball: Reads[5]": "Odd.ball: 5 is not an LCM type; import one from lcmtypes",
    "ball: Reads[command_t]": "Odd.ball: core.command_t belongs to the framework and "
    "does not begin with 'core.header_t header;'",
    "ball: Reads[odometry_t] = channel(5)": "Odd.ball: channel(5) does not name a channel; write = "
    "channel('cyan1/ball'), or nothing for 'ball'",
    "ball: Reads[odometry_t] = 'world/ball'": "Odd.ball: 'world/ball' does not name a channel; write = "
    "channel('cyan1/ball'), or nothing for 'ball'",
    "ball: Reads[odometry_t] = channel(history=-1)": "Odd.ball: history=-1: a history has at least 1 message",
    "ball: Writes[odometry_t] = channel(history=3)": "Odd.ball: history=3: only Reads keeps a history",
    "greedy: Greedy": "Greedy.ball: an aspect that a component provides has Reads, Each[Reads[...]], Image, Clock and "
    "Logger, not Writes; what a component writes is declared in its own class",
    "feeds: Feeds": "Feeds.balls: an aspect that a component provides has Reads, Each[Reads[...]], Image, Clock and "
    "Logger, not Each[Writes]; what a component writes is declared in its own class",
    "provides = Settings": "Odd: it provides <class 'odd{}.Settings'>, not an aspect; derive it from fwk.Aspect",
}


@pytest.mark.parametrize("number", range(len(ROWS)), ids=list(ROWS))
def test_mistake_is_reported(folder: Path, number: int) -> None:
    line, text = list(ROWS.items())[number]
    (folder / f"odd{number}.py").write_text(f"{HEAD}    {line}\n")
    (folder / "it.yaml").write_text(f"components: {{it/a: {{use: odd{number}:Odd}}}}")
    with pytest.raises(PlanError) as told:
        load_plan("it.yaml")
    assert str(told.value) == f"it.yaml:1: it/a: odd{number}.{text.format(number)}"


def test_methods_with_similar_names_are_left_alone(folder: Path) -> None:
    (folder / "calm.py").write_text(
        "from fwk import Component\n"
        'class Calm(Component):\n    stage = "think"\n    def loop(self) -> None: ...\n'
        "    def loops(self) -> int: ...\n    def look(self) -> None: ...\n    def _lop(self) -> None: ...\n"
    )
    (folder / "it.yaml").write_text("components: {it/a: {use: calm}}")
    assert [each.name for each in load_plan("it.yaml").components] == ["it/a"]
