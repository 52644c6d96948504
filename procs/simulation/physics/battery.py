"""A robot's battery: runs down by the power of computers, motors and kicker."""

from procs.simulation.physics.settings import BatterySettings

_J_PER_WH = 3600.0


class Battery:
    """Energy of one robot, from full to empty. Braking gives nothing back."""

    def __init__(self, settings: BatterySettings) -> None:
        self._settings = settings
        self._full_j = settings.capacity_wh * _J_PER_WH
        self._left_j = self._full_j

    @property
    def charge(self) -> float:
        """Share of the energy that is left, 0..1."""
        return self._left_j / self._full_j

    @property
    def empty(self) -> bool:
        """True if no energy is left."""
        return self._left_j <= 0.0

    @property
    def voltage_v(self) -> float:
        """Voltage between those of an empty and a full battery; it falls evenly with the charge."""
        low_v, high_v = self._settings.empty_v, self._settings.full_v
        return low_v + (high_v - low_v) * self.charge

    def drain(self, wheels_j: float, ball_j: float, rolled_n_m: float, duration_s: float) -> None:
        """Takes the energy of a tick out.

        Args:
            wheels_j: work of the wheels at their rims.
            ball_j: energy of the kicks, as the ball gets it.
            rolled_n_m: weight of the robot times the way that its wheels rolled.
            duration_s: duration of the tick.
        """
        settings = self._settings
        driving_j = (wheels_j + settings.rolling_resistance * rolled_n_m) / settings.drive_efficiency
        used_j = settings.idle_w * duration_s + driving_j + ball_j / settings.kick_efficiency
        self._left_j = max(0.0, self._left_j - used_j)

    def refill(self) -> None:
        """Puts a full battery in."""
        self._left_j = self._full_j
