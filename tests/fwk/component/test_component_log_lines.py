"""Components that are targets of the log."""

from pathlib import Path

import pytest

from fwk import Component, Logger, LogLines, Writes
from fwk.component.port import DeclarationError
from fwk.model.errors import PlanError
from fwk.plan.load import load_plan
from fwk.testing import Bench, MemorySystem
from lcmtypes.core import log_t
from lcmtypes.robot import imu_t


class Alarm(Component):
    """Counts the warnings and errors it hears, and logs each itself."""

    stage = "post_loop"
    lines: LogLines
    log: Logger
    heard: Writes[imu_t]

    def loop(self) -> None:
        for line in self.lines.of("warning"):
            self.log.error(f"{line.component} says {line.text}")
            self.heard.value.heading_rad += 1.0
        self.heard.write()


class Worrier(Component):
    stage = "think"
    log: Logger

    def loop(self) -> None:
        self.log.info("all is well")
        self.log.warning("or is it")


def line(level: int, text: str, component: str = "b/other") -> log_t:
    made = log_t()
    made.level, made.text, made.component = level, text, component
    return made


def test_log_lines_arrive_from_the_requested_level_on() -> None:
    bench = Bench(Alarm, name="a/alarm")
    port = bench.port("lines")
    port.put(line(log_t.INFO, "nothing"))
    port.put(line(log_t.WARNING, "smoke"))
    port.put(line(log_t.ERROR, "its own", component="a/alarm"))
    port.put(line(log_t.ERROR, "fire"))
    bench.iterate()
    assert [each.text for each in bench.logged] == ["b/other says smoke", "b/other says fire"]
    assert [each.text for each in bench.component.lines.fresh] == ["nothing", "smoke", "fire"]
    bench.iterate()
    assert len(bench.logged) == 2


def test_a_level_that_does_not_exist_is_refused() -> None:
    bench = Bench(Alarm)
    with pytest.raises(ValueError, match="no level 'loud'; the levels are debug, info, warning, error"):
        bench.component.lines.of("loud")


def test_memory_system_delivers_log_lines_from_the_next_tick() -> None:
    system = MemorySystem({"a/worrier": Worrier, "a/alarm": Alarm})
    system.tick(5)
    assert system.newest("a/heard").heading_rad == 4.0  # an alarm for each alarm would never end


def test_a_launch_file_cannot_connect_them_elsewhere(tmp_path: Path) -> None:
    (tmp_path / "alarms.py").write_text(
        "from fwk import Component, LogLines\n\n\nclass Alarm(Component):\n    stage = 'think'\n    lines: LogLines\n"
    )
    (tmp_path / "it.yaml").write_text("components: {a/alarm: {use: alarms, channels: {lines: b/lines}}}")
    with pytest.raises(PlanError, match=r"it\.yaml:1: a/alarm: port 'lines': it is a target of the log"):
        load_plan(str(tmp_path / "it.yaml"))


def test_a_misspelt_log_port_is_named() -> None:
    class Wrong(Component):
        stage = "think"
        lines: int

    with pytest.raises(DeclarationError, match="Logger, LogLines"):
        Bench(Wrong)
