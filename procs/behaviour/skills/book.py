"""All skills by the names that agents use, and the machine that runs one at a time."""

from procs.behaviour.skills.getting import GetBall, Intercept
from procs.behaviour.skills.keeping import KeepGoal
from procs.behaviour.skills.moving import Goto, Mark, Stop
from procs.behaviour.skills.playing import Dribble, Pass, Shoot
from procs.behaviour.skills.skill import Scene, Skill, Status, Step

SKILLS: dict[str, type[Skill]] = {
    "stop": Stop,
    "goto": Goto,
    "get_ball": GetBall,
    "dribble": Dribble,
    "shoot": Shoot,
    "pass": Pass,
    "intercept": Intercept,
    "keep_goal": KeepGoal,
    "mark": Mark,
}


class Machine:
    """Runs the skill of the newest command.

    A new command for the same skill moves its target while it runs; it begins anew if it had ended. A skill that
    has reached its end stays there if it is a lasting one; the others stop the robot and wait for a new command.
    """

    def __init__(self) -> None:
        self._name = ""
        self._skill: Skill = Stop()
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
