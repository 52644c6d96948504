"""All skills by the names that agents use, and the runner of one skill at a time."""

from procs.behaviour.skills.getting import GetBall, Intercept, Receive
from procs.behaviour.skills.keeping import KeepGoal, KeepLine
from procs.behaviour.skills.moving import Block, Goto, Mark, Stop
from procs.behaviour.skills.playing import Aim, Clear, Dribble, Lob, Pass, Push, Shoot
from procs.behaviour.skills.searching import Search
from procs.behaviour.skills.skill import Scene, Status, Step
from procs.behaviour.skills.states import StateMachine

SKILLS: dict[str, type[StateMachine]] = {
    "stop": Stop,
    "search": Search,
    "goto": Goto,
    "get_ball": GetBall,
    "dribble": Dribble,
    "aim": Aim,
    "shoot": Shoot,
    "lob": Lob,
    "pass": Pass,
    "push": Push,
    "clear": Clear,
    "intercept": Intercept,
    "receive": Receive,
    "keep_goal": KeepGoal,
    "keep_line": KeepLine,
    "mark": Mark,
    "block": Block,
}


class SkillRunner:
    """Runs the skill of the newest command.

    A new command for the same skill moves its target while it runs; it begins anew if it had ended. A skill that
    has reached its end stays there if it is a lasting one; the others stop the robot and wait for a new command.
    """

    def __init__(self) -> None:
        self._name = ""
        self._skill: StateMachine = Stop()
        self._ended: Step | None = None

    def begin(self, name: str) -> None:
        """Takes a new command.

        Raises:
            KeyError: no skill has that name.
        """
        if name != self._name or self._ended:
            self._name, self._skill, self._ended = name, SKILLS[name](), None

    def step(self, scene: Scene) -> Step:
        """Runs one tick of the newest command; without a command the robot stands."""
        if not self._name:
            return Step(status=Status.INACTIVE)
        if self._ended:
            return self._ended._replace(drive=None, kick_m_s=0.0, dribble=scene.holds_ball)
        step = self._skill.step(scene)
        if step.status is not Status.RUNNING and not self._skill.lasting:
            self._ended = step
        return step
