"""Driver of the kicker: fires a kick once ball and charge are there, and reports the kicks carried out."""

from pydantic import PositiveFloat

from fwk import Clock, Component, Config, Logger, Reads, Writes
from lcmtypes.robot import kick_command_t, kicker_drive_t, kicker_sensor_t, kicker_state_t


class KickerConfig(Config):
    """Settings of the kicker's driver."""

    speed_limit_m_s: PositiveFloat = 12.0
    """Highest speed of a kick."""
    command_timeout_s: PositiveFloat = 0.25
    """Without a newer kick command ball handling stops, and a kick that has not been carried out is forgotten."""


class Kicker(Component):
    """State of the kicker when sensors are read, its drive when actuators act.

    Kicks are numbered from 1. A kick whose number is not that of the newest one carried out waits for ball and charge
    as long as its command is younger than the time-out; a command with speed 0 takes it back.
    """

    stage = ("sensor_acquire", "act_exec")

    kicker_sensor: Reads[kicker_sensor_t]
    kick_command: Reads[kick_command_t]
    kicker_state: Writes[kicker_state_t]
    kicker_drive: Writes[kicker_drive_t]
    config: KickerConfig
    clock: Clock
    log: Logger

    def init(self) -> None:
        self._kicks = 0
        self._speeds_m_s: dict[int, float] = {}  # of kicks asked of the hardware and not yet carried out
        self._late = False

    def loop(self) -> None:
        for sensor in self.kicker_sensor.fresh:
            if sensor.kick_id != self.kicker_state.value.kick_id:
                self._kicks += 1
                self.kicker_state.value.kick_speed_m_s = self._speeds_m_s.get(sensor.kick_id, 0.0)
                self._speeds_m_s.clear()
            self.kicker_state.value.kick_id = sensor.kick_id
        if self.clock.stage == "act_exec":
            self._act()
        else:
            self._report()

    def finalize(self) -> None:
        """Leaves ball handling off and no kick waiting."""
        self.kicker_drive.value = kicker_drive_t()
        self.kicker_drive.value.kick_id = self.kicker_sensor.value.kick_id
        self.kicker_drive.write()

    def _report(self) -> None:
        state, sensor = self.kicker_state.value, self.kicker_sensor.value
        state.ball_held, state.charged, state.kicks = sensor.ball_held, sensor.charged, self._kicks
        self.kicker_state.write()

    def _act(self) -> None:
        command, sensor, drive = self.kick_command.value, self.kicker_sensor.value, self.kicker_drive.value
        fresh = self._is_fresh()
        wanted = fresh and command.kick_id != sensor.kick_id and command.speed_m_s > 0
        fire = wanted and sensor.ball_held and sensor.charged
        drive.kick_id = command.kick_id if fire else sensor.kick_id
        drive.kick_m_s = min(command.speed_m_s, self.config.speed_limit_m_s) if fire else 0.0
        if fire:
            self._speeds_m_s[drive.kick_id] = drive.kick_m_s
        drive.dribble = fresh and command.dribble
        self.kicker_drive.write()

    def _is_fresh(self) -> bool:
        age_s = self.clock.since_s(self.kick_command.header.time_us)
        late = self.kick_command.has_value and age_s > self.config.command_timeout_s
        if late and not self._late:
            self.log.warning(f"no kick command for {age_s:.2f} s: ball handling stops")
        self._late = late
        return self.kick_command.has_value and not late
