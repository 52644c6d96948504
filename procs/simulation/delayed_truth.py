"""The world as a sensor saw it: at the capture, a latency before the sensor publishes."""

from typing import NamedTuple

from fwk import Logger, Reads
from lcmtypes.soccer import ground_truth_t, true_robot_t
from procs.model.geometry import plausible
from procs.model.units import US_PER_S
from procs.simulation.past import Past


class Exposure(NamedTuple):
    """The true world at a capture time, as it concerns a sensor on a robot."""

    capture_us: int
    own: true_robot_t
    """Robot that has the sensor."""
    others: list[true_robot_t]
    """All other robots on the field."""
    truth: ground_truth_t


class DelayedTruth:
    """Collects the simulator's messages for one sensor of one robot, and looks back by the sensor's latency."""

    def __init__(self, sensor: str, product: str, log: Logger) -> None:
        """`sensor` is the name of the component, `product` that of its output, for the warning without a robot."""
        self._robot = sensor.rpartition("/")[0]
        self._product = product
        self._log = log
        self._past = Past()
        self._missing = False

    def expose(self, ground_truth: Reads[ground_truth_t], latency_s: float) -> Exposure | None:
        """Takes the fresh messages and returns the world `latency_s` before the newest.

        Returns None without a new message, while the robot is not on the field, and for the first `latency_s` of a
        sensor that starts during a run, because it does not know the world at its exposures.
        """
        if not ground_truth.refreshed:
            return None
        for truth in ground_truth.fresh:
            self._past.add(truth)
        capture_us = ground_truth.header.time_us - round(latency_s * US_PER_S)
        if not self._past.reaches(capture_us):
            return None
        truth = self._past.at(capture_us)
        robots = [robot for robot in truth.robots if _on_field(robot)]
        own = next((robot for robot in robots if robot.name == self._robot), None)
        self._warn(own is None, truth)
        if own is None:
            return None
        others = [robot for robot in robots if robot.name != self._robot]
        return Exposure(max(1, capture_us), own, others, truth)

    def _warn(self, missing: bool, truth: ground_truth_t) -> None:
        if missing and not self._missing:
            names = ", ".join(robot.name for robot in truth.robots) or "no robot"
            self._log.warning(f"no {self._product}: robot '{self._robot}' is not on the field, which has {names}")
        self._missing = missing


def _on_field(robot: true_robot_t) -> bool:
    return plausible(robot.x_m, robot.y_m, robot.heading_rad, robot.vx_m_s, robot.vy_m_s)
