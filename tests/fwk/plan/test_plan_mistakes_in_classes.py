"""What the check says of a component's class: one row for each thing that a class can say wrongly."""

from pathlib import Path

import pytest

from fwk.model.errors import PlanError
from fwk.plan.load import load_plan

HEAD = """
from fwk import Aspect, Clock, Component, Config, MainLoop, Reads, ReadsEach, Serves, Writes, channel
from lcmtypes.core import command_t
from lcmtypes.robot import odometry_t
class Settings(Config):
    gain: float = 1.0
class Levelled(Config):
    log_level: str = "all"
class Greedy(Aspect):
    ball: Writes[odometry_t]
class Odd(Component):
    stage = "think"
"""
ROWS = {
    "stage = 5": """Odd: stage is 5; it should be text such as "think", or a tuple of it""",
    "stage = ('think', 3)": """Odd: stage is ('think', 3); it should be text such as "think", or a tuple of it""",
    "loop: Reads[odometry_t]": "Odd.loop: every component has 'loop'; call this one otherwise",
    "finalize: Clock": "Odd.finalize: every component has 'finalize'; call this one otherwise",
    "settings: Settings": "Odd.settings: settings are called 'config'",
    "config: Levelled": "Odd: every component has a setting 'log_level'; call its own otherwise",
    "ball: 'Reads[odometry_t'": "Odd: an annotation cannot be read: Forward reference must be an expression -- got "
    "'Reads[odometry_t'",
    "ball: 'Reads[ball_t]'": "Odd: an annotation cannot be read: name 'ball_t' is not defined",
    "def lop(self) -> None: ...": "Odd.lop: the framework calls no method 'lop'; did you mean 'loop'?",
    "def Finalise(self) -> None: ...": "Odd.Finalise: the framework calls no method 'Finalise'; "
    "did you mean 'finalize'?",
    "ball: Reads": "Odd.ball: Reads of which messages? name its type: ball: Reads[message_t]",
    "way: Serves": "Odd.way: Serves of which messages? name its type: way: Serves[request_t, reply_t]",
    "ball: int": "Odd.ball: int is not an aspect; annotate with Reads, Writes, ReadsEach, WritesEach, Commands, "
    "CommandsEach, Sends, SendsEach, Serves, ServesEach, Calls, CallsEach, Image, ImagesEach, "
    "VisionMaster, a Config, Clock, Logger, LogLines, numpy.random.Generator, TimeSource, MainLoop, "
    "PluginControl, Blackboard or an Aspect, and set plain attributes in init()",
    "ball: Reads[int]": "Odd.ball: <class 'int'> is no LCM type; import it from lcmtypes",
    "ball: Reads[command_t]": "Odd.ball: core.command_t is the framework's own and "
    "does not begin with 'core.header_t header;'",
    "ball: Reads[odometry_t] = channel(5)": "Odd.ball: channel(5) names no channel; write = channel('cyan1/ball'), "
    "or nothing for 'ball'",
    "ball: Reads[odometry_t] = 'world/ball'": "Odd.ball: 'world/ball' names no channel; write = "
    "channel('cyan1/ball'), or nothing for 'ball'",
    "ball: Reads[odometry_t] = channel(history=-1)": "Odd.ball: history=-1: a history has at least 1 message",
    "ball: Writes[odometry_t] = channel(history=3)": "Odd.ball: history=3: only Reads and ReadsEach keep a history",
    "greedy: Greedy": "Greedy.ball: an aspect that a component provides has Reads, ReadsEach, Image, Clock and Logger, "
    "not Writes; what a component writes stands in its own class",
    "provides = Settings": "Odd: it provides <class 'odd{}.Settings'>, which is no aspect; derive it from fwk.Aspect",
}


@pytest.mark.parametrize("number", range(len(ROWS)), ids=list(ROWS))
def test_it_is_told(folder: Path, number: int) -> None:
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
