"""Systems in memory of the components of a launch file: as the run would play them."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from fwk import Aspect, Calls, Clock, Component, Reads, Serves, Writes
from fwk.testing import MemorySystem, launch_plan, system_of
from lcmtypes.robot import imu_t, kick_command_t, odometry_t


class Battery(Aspect):
    imu: Reads[imu_t]


class Gauge(Component):
    stage = "think"
    provides = Battery
    clock: Clock
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.write()


class Often(Component):
    rate_hz = 20.0
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.write()


class User(Component):
    stage = "act"
    battery: Battery
    odometry: Writes[odometry_t]

    def loop(self) -> None:
        self.odometry.value.x_m = float(self.battery.imu.header.sequence)
        self.odometry.write()


class Follower(Component):
    stage = "act"
    odometry: Reads[odometry_t]
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad = self.odometry.value.x_m
        self.imu.write()


class Kicker(Component):
    stage = "act"
    kick: Serves[kick_command_t]


class Caller(Component):
    stage = "think"
    kick: Calls[kick_command_t]

    def loop(self) -> None:
        self.kick.call()


@pytest.fixture
def file(tmp_path: Path) -> Iterator[Path]:
    yield tmp_path / "it.yaml"
    launch_plan.cache_clear()


def system(file: Path, components: str, more: str = "") -> MemorySystem:
    """Returns the system of a launch file; `use: :Gauge` names a class of this module."""
    file.write_text(f"name: it\n{more}\ncomponents:\n{components}".replace("use: :", f"use: {__name__}:"))
    made = system_of(str(file))
    made.tick(4)
    return made


def test_components_iterate_in_the_stages_of_the_file(file: Path) -> None:
    made = system(file, "  r/gauge: {use: :Gauge, stage: [go, stop], every: 2}", "stages: [go, stop]")
    headers = [imu_t.decode(data).header for data in made.sent["r/imu"]]
    assert [(header.tick, header.stage) for header in headers] == [(2, 0), (2, 1), (4, 0), (4, 1)]


def test_continuous_components_have_the_rate_of_the_file(file: Path) -> None:
    assert len(system(file, "  r/often: {use: :Often, rate_hz: 10}").sent["r/imu"]) == 2


def test_an_aspect_has_the_provider_of_the_file(file: Path) -> None:
    lines = [
        "  r/one: {use: :Gauge, channels: {imu: one}}",
        "  r/two: {use: :Gauge, channels: {imu: two}, every: 4}",
        "  r/user: {use: :User, providers: {battery: two}}",
    ]
    assert system(file, "\n".join(lines)).newest("r/odometry").x_m == 1.0


def test_programs_outside_write_the_channels_of_the_file(file: Path) -> None:
    made = system(file, "  r/follower: {use: :Follower}", "outside: {r/odometry: robot.odometry_t}")
    made.come_in("r/odometry", odometry_t(x_m=2.0))
    made.tick()
    assert made.newest("r/imu").heading_rad == 2.0


def test_components_that_start_on_request_stay_out(file: Path) -> None:
    lines = "  r/user: {use: :User, start: false}\n  r/gauge: {use: :Gauge}\n  s/follower: {use: :Follower, %s}"
    made = system(file, lines % "channels: {odometry: r/odometry}")
    assert (sorted(made.runners), made.newest("s/imu").heading_rad) == (["r/gauge", "s/follower"], 0.0)
    assert "r/user" in system_of(str(file), bool).runners


def test_commands_to_a_component_that_stays_out_wait(file: Path) -> None:
    made = system(file, "  r/kicker: {use: :Kicker, start: false}\n  r/caller: {use: :Caller}")
    assert (len(made.sent["r/kick@r/caller"]), made.sent["r/kick@answers"]) == (4, [])


def test_component_without_the_provider_of_its_aspect_is_refused(file: Path) -> None:
    system(file, "  r/user: {use: :User}\n  r/gauge: {use: :Gauge}")
    with pytest.raises(ValueError, match="'r/gauge' does not provide Battery"):
        system_of(str(file), lambda name: name == "r/user")
