"""The published state of a component."""

import pytest

from fwk import Component, Writes
from fwk.supervisor.control.view import component_view
from fwk.supervisor.host_process import host_processes
from fwk.testing.plans import plan_of
from lcmtypes.robot import imu_t


class Staged(Component):
    stage = "think"
    imu: Writes[imu_t]


class AtItsOwnRate(Component):
    rate_hz = 5.0
    imu: Writes[imu_t]


class AsSoonAsThereIsSomethingNew(Component):
    rate_hz = 0.0
    imu: Writes[imu_t]


@pytest.mark.parametrize(
    ("kind", "period_s"), [(Staged, 0.02), (AtItsOwnRate, 0.2), (AsSoonAsThereIsSomethingNew, 0.0)]
)
def test_the_period_is_that_of_its_own_iterations(kind: type[Component], period_s: float) -> None:
    plan = plan_of({"r/it": kind}, period_s=0.02)
    assert component_view(plan, plan.components[0], host_processes(plan)[0])["period_s"] == period_s
