"""Runs the skill that the agent asks for: says where to drive, when to handle the ball and when to kick."""

from fwk import Clock, Component, Config, Logger, Reads, Writes, channel
from lcmtypes.robot import kick_command_t, kicker_state_t
from lcmtypes.soccer import drive_target_t, game_state_t, skill_command_t, skill_status_t, world_model_t
from procs.behaviour.game import Whose, game_of
from procs.behaviour.skills.book import Machine
from procs.behaviour.skills.skill import Drive, Scene, Status, Step
from procs.behaviour.view import Frame, view_of
from procs.model.field import Field
from procs.model.geometry import plausible
from procs.model.robot import side_of, team_of
from procs.referee.restarts import team_number


class SkillerConfig(Config):
    """Settings of the skills."""

    field: Field = Field()
    """Measures of the field."""


class Skiller(Component):
    """Thinks in the attack frame, speaks in the world frame."""

    stage = "skill"

    config: SkillerConfig
    clock: Clock
    log: Logger
    skill_command: Reads[skill_command_t]
    world_model: Reads[world_model_t]
    kicker_state: Reads[kicker_state_t]
    game_state: Reads[game_state_t] = channel("world/game_state")
    skill_status: Writes[skill_status_t]
    drive_target: Writes[drive_target_t]
    kick_command: Writes[kick_command_t]

    def init(self) -> None:
        self._robot = self.name.rpartition("/")[0]
        self._frame = Frame(-side_of(team_of(self._robot)))
        self._machine = Machine()

    def loop(self) -> None:
        command = self.skill_command.value
        step = Step(status=Status.INACTIVE)
        if self.skill_command.has_value and plausible(command.x_m, command.y_m, command.heading_rad, command.speed_m_s):
            step = self._machine.step(command.command_id, command.skill, self._scene(command))
        self._report(command, step)
        self._drive(step.drive)
        self._kick(step)

    def finalize(self) -> None:
        """Leaves the robot without a target and the ball handling off."""
        self._drive(None)
        self._kick(Step(status=Status.INACTIVE))

    def _scene(self, command: skill_command_t) -> Scene:
        kicker = self.kicker_state.value
        game = game_of(self.game_state.value, team_number(self._robot), self._frame)
        return Scene(
            view_of(self.world_model.value, self._robot, "", self._frame),
            self._frame.point(command.x_m, command.y_m),
            self._frame.heading_rad(command.heading_rad),
            command.speed_m_s,
            kicker.ball_held,
            kicker.charged,
            kicker.kick_id,
            self._newest_kick,
            set_piece=game.whose is Whose.OURS and not game.free_play,
            duration_s=self.clock.period_s,
            field=self.config.field,
        )

    @property
    def _newest_kick(self) -> int:
        # After a restart numbers go on from the kicker's, so that the next kick is again a new one.
        return max(self.kick_command.value.kick_id, self.kicker_state.value.kick_id)

    def _report(self, command: skill_command_t, step: Step) -> None:
        status = self.skill_status.value
        if step.status is Status.FAILED and (status.status, status.command_id) != (Status.FAILED, command.command_id):
            self.log.debug(f"{command.skill} failed: {step.reason}")
        status.status, status.command_id, status.skill, status.reason = (
            step.status,
            command.command_id,
            command.skill,
            step.reason,
        )
        self.skill_status.write()

    def _drive(self, drive: Drive | None) -> None:
        target = self.drive_target.value
        before = (target.stop, target.x_m, target.y_m, target.heading_rad)
        target.stop = drive is None
        if drive is not None:
            target.x_m, target.y_m = self._frame.point(*drive.place)
            target.heading_rad = self._frame.heading_rad(drive.heading_rad)
            target.speed_m_s, target.end_speed_m_s = drive.speed_m_s, drive.end_speed_m_s
            target.avoid_ball, target.avoid_robots = drive.avoid_ball, drive.avoid_robots
        if (target.stop, target.x_m, target.y_m, target.heading_rad) != before:
            target.target_id += 1
        self.drive_target.write()

    def _kick(self, step: Step) -> None:
        kick = self.kick_command.value
        if step.kick_m_s > 0:
            kick.kick_id = self._newest_kick + 1
        kick.speed_m_s, kick.dribble = step.kick_m_s, step.dribble
        self.kick_command.write()
