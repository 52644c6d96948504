"""A plan of two hosts: a writer, with readers beside it and elsewhere."""

from fwk import Component, Reads, Writes
from fwk.model.plan import Plan
from fwk.testing.plans import plan_of
from lcmtypes.robot import imu_t

IMU = "r/imu"


class Senses(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]


class Thinks(Component):
    stage = "think"
    imu: Reads[imu_t]


def plan(bus_port: int, together: bool = False) -> Plan:
    """A plan with writer and reader in host 0 and 1, or both in host 0."""
    groups = [["r/senses", "r/thinks"]] if together else None
    return plan_of({"r/senses": Senses, "r/thinks": Thinks}, groups=groups, bus_port=bus_port)


def imu(sequence: int, writer: str = "r/senses") -> bytes:
    """Returns a message with this number."""
    made = imu_t()
    made.header.sequence, made.header.writer, made.header.tick = sequence, writer, sequence
    return made.encode()
