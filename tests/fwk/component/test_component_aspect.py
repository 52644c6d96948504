"""Aspects that components provide: valid classes, and what users of the aspects get."""

import pytest

from fwk import Aspect, Clock, Component, Each, Logger, Reads, VisionMaster, Writes
from fwk.component.declaration import declaration
from fwk.component.port import DeclarationError
from fwk.engine.runner import Runner
from fwk.testing.bench import Bench
from fwk.testing.memory import MemorySystem
from lcmtypes.robot import imu_t, odometry_t


class Compass(Aspect):
    imu: Reads[imu_t]
    others: Each[Reads[imu_t]]
    clock: Clock
    log: Logger

    def init(self) -> None:
        self.seen = 0
        self.log.info("ready")

    def begin(self) -> None:
        self.seen += len(self.imu.fresh)

    def turned(self) -> float:
        return self.imu.value.heading_rad + self.clock.tick


class Gyro(Component):
    stage = "sensor_acquire"
    provides = Compass
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad += 10.0
        self.imu.write()


class Helm(Component):
    stage = "act"
    compass: Compass
    odometry: Writes[odometry_t]

    def init(self) -> None:
        self.at_start = self.compass.seen

    def loop(self) -> None:
        self.odometry.value.x_m, self.odometry.value.y_m = self.compass.turned(), self.compass.seen
        self.odometry.write()


def test_user_gets_the_providers_messages_and_behaviour() -> None:
    system = MemorySystem({"r/helm": Helm, "r/gyro": Gyro})
    system.tick(3)
    told = system.newest("r/odometry")
    assert (told.x_m, told.y_m) == (33.0, 3.0)
    assert [line.text for line in system.logged] == ["ready"]
    assert system.logged[0].component == "r/helm"


def test_the_channel_is_the_providers_even_if_renamed() -> None:
    system = MemorySystem({"r/helm": Helm, "s/gyro": Gyro}, channels={"s/gyro": {"imu": "far/heading"}})
    system.tick()
    assert set(system.sent) == {"far/heading", "r/odometry"}
    assert system.newest("r/odometry").x_m == 11.0


def test_on_the_bench_its_ports_have_dotted_names() -> None:
    bench = Bench(Helm)
    bench.port("compass.imu").put(heading_rad=5.0)
    bench.iterate()
    assert bench.port("odometry").sent[0].x_m == 6.0


def test_an_aspect_that_fails_fails_its_component() -> None:
    class Broken(Aspect):
        def begin(self) -> None:
            raise ValueError("no north")

    class Sailor(Component):
        stage = "act"
        broken: Broken

    with pytest.raises(ValueError, match="no north"):
        Bench(Sailor).iterate()


def test_a_component_without_aspects_has_no_begin() -> None:
    runner: Runner = Bench(Gyro).runner
    assert runner._provided == []


class Talkative(Aspect):
    said: Writes[imu_t]


class Pictures(Aspect):
    from fwk import Image

    image: Image


class Asker(Component):
    stage = "act"
    said: Talkative


class Nothing(Component):
    stage = "act"
    provides = int  # type: ignore[assignment]


class Mute(Component):
    stage = "act"
    provides = Compass


class Mistyped(Component):
    stage = "act"
    provides = Compass
    imu: Writes[odometry_t]


class Painter(Component):
    stage = "act"
    provides = (Compass, Pictures)
    imu: Writes[imu_t]


class Photographer(Painter):
    image: VisionMaster


@pytest.mark.parametrize(
    ("component", "says"),
    [
        (Asker, r"Talkative\.said: an aspect that a component provides has Reads, .*, not Writes; what a component wr"),
        (Nothing, r"Nothing: it provides <class 'int'>, not an aspect; derive it from fwk\.Aspect"),
        (Mute, r"Mute: it provides Compass, which reads its channel 'imu'; add imu: Writes\[imu_t\]"),
        (Mistyped, r"Mistyped: it provides Compass, which reads its channel 'imu'; add imu: Writes\[imu_t\]"),
        (Painter, r"Painter: it provides Pictures, which reads its channel 'image'; add image: VisionMaster"),
    ],
)
def test_impossible_classes_are_refused(component: type[Component], says: str) -> None:
    with pytest.raises(DeclarationError, match=says):
        declaration(component)


def test_a_component_may_provide_several_aspects() -> None:
    assert declaration(Photographer).provides == (Compass, Pictures)
