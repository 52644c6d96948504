"""Field crew of a scenario: sets robots and ball down, and gives the referee commands, each at its time."""

from typing import TYPE_CHECKING, Any

from pydantic import Field, NonNegativeFloat, ValidationInfo, field_validator

from fwk import Call, Calls, Clock, Component, Config, Logger, Reads, Request, Serves, channel
from lcmtypes.soccer import (
    freeze_world_t,
    ground_truth_t,
    hold_robot_t,
    place_ball_t,
    place_robot_t,
    play_scenario_t,
    referee_command_t,
    reset_world_t,
)
from procs.model.field import Field as SoccerField
from procs.model.field import MatchField
from procs.model.units import US_PER_S
from procs.scenarios.action import Action

if TYPE_CHECKING:
    from procs.scenarios.file import Scenario

_WHEELS = "/wheel_command"
"""End of the name of a channel that each robot has."""
_TOLD = 8
"""Mistakes of a scenario that an answer tells."""


class CrewConfig(Config):
    """Settings of the crew."""

    actions: list[Action] = Field([], frozen=True)
    """Actions in any order."""
    field: MatchField = Field(SoccerField(), frozen=True)
    """Measures of the field."""
    settle_s: NonNegativeFloat = 1.0
    """How long the world stands still at the start of a scenario, so that robots find their new places."""

    @field_validator("actions")
    @classmethod
    def _of_robots(cls, actions: list[Action], info: ValidationInfo) -> list[Action]:
        """Refuses robots that the system does not have, as soon as its robots are known."""
        if info.context is not None:
            channels = info.context["all_channels"]
            robots = [name.removesuffix(_WHEELS) for name in channels if name.endswith(_WHEELS)]
            found = [(each, each.stranger(sorted(robots))) for each in actions]
            if mistakes := [f"{each.kind} at {each.at_s:g} s: {stranger}" for each, stranger in found if stranger]:
                raise ValueError("; ".join(mistakes))
        return actions


class Crew(Component):
    """Carries out its actions in the order of their times, and plays scenarios in a running match.

    `fwk call world/scenario name=pass-reaches-the-mate`
    """

    stage = "sensor_acquire"

    config: CrewConfig
    clock: Clock
    log: Logger
    ground_truth: Reads[ground_truth_t] = channel("world/ground_truth")
    scenario: Serves[play_scenario_t]
    place_ball: Calls[place_ball_t] = channel("world/place_ball")
    place_robot: Calls[place_robot_t] = channel("world/place_robot")
    hold_robot: Calls[hold_robot_t] = channel("world/hold_robot")
    freeze: Calls[freeze_world_t] = channel("world/freeze")
    reset: Calls[reset_world_t] = channel("world/reset")
    referee: Calls[referee_command_t] = channel("world/referee_command")

    def init(self) -> None:
        self._left = sorted(self.config.actions, key=lambda action: action.at_s)
        self._asked: list[tuple[Action, Call]] = []
        self._begun_us = 0  # time 0 of the actions
        self._ends_s: float | None = None  # after that; None: no scenario is played
        self._start: tuple[Request[play_scenario_t], Scenario, int] | None = None  # under way, since that time
        self.refused: list[str] = []
        """Actions that the simulator or the referee did not carry out, and why."""

    @property
    def unanswered(self) -> list[str]:
        """Actions that wait for their time, and how many have no answer yet."""
        late = [f"not given: the command at {each.at_s:g} s" for each in self._left]
        return late + ([f"without an answer: {len(self._asked)} commands"] if self._asked else [])

    def loop(self) -> None:
        if self.ground_truth.has_value:
            for request in self.scenario:
                self._prepare(request)
        self._hear()
        if self._start and not self._asked and self.clock.since_s(self._start[2]) >= self.config.settle_s:
            self._begin(*self._start[:2])
        passed_us = self.clock.now_us - self._begun_us
        while self._left and self._left[0].at_s * US_PER_S <= passed_us:
            self._do(self._left.pop(0))
        if self._ends_s is not None and passed_us >= self._ends_s * US_PER_S:
            self._ends_s = None
            self.log.info("the scenario is over; the match goes on")

    def _prepare(self, request: Request[play_scenario_t]) -> None:
        """Has robots and ball put to their places, instead of what the crew was at."""
        from procs.scenarios.file import ScenarioError  # imports what a match without scenarios does not need
        from procs.scenarios.start import found, start_of

        robots = [robot.name for robot in self.ground_truth.value.robots]
        try:
            scenario = found(request.value.name, request.value.text)
        except ScenarioError as error:
            mistakes = str(error).splitlines()
            more = f"; and {len(mistakes) - _TOLD} more" if len(mistakes) > _TOLD else ""
            request.reject("; ".join(mistakes[:_TOLD]) + more)
            return
        strangers = [robot for robot in scenario.everyone if robot not in robots]
        if strangers:
            request.reject(f"no robot '{strangers[0]}' in this match; there are: {', '.join(robots)}")
            return
        if self._start:
            self._start[0].fail("another scenario was asked for before this one began")
        request.accept()
        self._start, self._ends_s = (request, scenario, self.clock.now_us), None
        self._left, self._asked, self.refused = [], [], []
        for action in start_of(scenario, robots, self.config.field):
            self._do(action)

    def _begin(self, request: Request[play_scenario_t], scenario: "Scenario") -> None:
        """Lets the world move and begins with the actions of the scenario."""
        from procs.scenarios.start import left_out, play_of

        self._start = None
        if self.refused:
            self._do(Action(freeze={"frozen": False}))
            request.fail("; ".join(self.refused))
            return
        request.done()
        self._begun_us, self._left, self._ends_s = self.clock.now_us, play_of(scenario), scenario.time_s
        self.log.info(f"the scenario {request.value.name or 'given as text'} begins; it takes {scenario.time_s:g} s")
        if kept := left_out(scenario):
            self.log.warning(f"the match keeps its own settings; the scenario states others: {', '.join(kept)}")
        if scenario.scripted:
            self.log.warning(f"a match has no scripted robots; they are held: {', '.join(scenario.scripted)}")

    def _hear(self) -> None:
        for action, call in [each for each in self._asked if each[1].finished]:
            self._asked.remove((action, call))
            if not call.done:
                self.refused.append(f"refused: the command at {action.at_s:g} s: {call.reason}")
                self.log.error(self.refused[-1])

    def _do(self, action: Action) -> None:
        port: Calls[Any] = getattr(self, action.kind)
        port.value = action.message
        self._asked.append((action, port.call()))
