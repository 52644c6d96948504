"""Log lines of a component: cheap when off, limited in number and length, with their place in the source."""

import os

import pytest

from fwk import Component, Config, Logger
from fwk.clock import US_PER_S, Clock
from fwk.component import log as logging
from fwk.component.declaration import declaration
from fwk.component.port import DeclarationError
from fwk.component.rate_limit import RateLimit
from fwk.lcm import wire
from fwk.testing.bench import Bench
from lcmtypes.core import log_t


class Wall:
    now_us = 0

    def __call__(self) -> int:
        return self.now_us


def logger(lines: list[log_t], wall: Wall, per_s: int = 3, level: int = log_t.INFO) -> Logger:
    return Logger("a/b", Clock(), lines.append, level, RateLimit(per_s, wall))


def test_a_line_says_where_it_was_written() -> None:
    lines: list[log_t] = []
    log = logger(lines, Wall())
    log.warning("hot")
    (line,) = lines
    assert (line.level, line.component, line.text) == (log_t.WARNING, "a/b", "hot")
    assert os.path.basename(line.file) == os.path.basename(__file__)
    assert line.line == test_a_line_says_where_it_was_written.__code__.co_firstlineno + 3


def test_a_line_that_is_off_is_not_formatted() -> None:
    lines: list[log_t] = []
    log = logger(lines, Wall(), level=log_t.ERROR)
    for write in (log.debug, log.info, log.warning):
        write(lambda: pytest.fail("made"))
    log.error(lambda: "made")
    assert [line.text for line in lines] == ["made"]


def test_a_flood_is_cut_off_and_counted_after_its_second() -> None:
    lines, wall = list[log_t](), Wall()
    log = logger(lines, wall)
    for number in range(10):
        log.info(f"flood {number}")
    log._report_dropped()
    assert [line.text for line in lines] == ["flood 0", "flood 1", "flood 2"]
    wall.now_us += US_PER_S
    log._report_dropped()
    log._report_dropped()
    log.info("calm")
    told, calm = lines[3:]
    assert told.text.startswith("7 lines dropped in the last second")
    assert (told.level, told.line) == (log_t.WARNING, lines[0].line)
    assert calm.text == "calm"


def test_lasting_flood_is_reported_each_second_and_at_the_end() -> None:
    lines, wall = list[log_t](), Wall()
    log = logger(lines, wall)
    for number in range(15):
        wall.now_us = number // 5 * US_PER_S
        log.info("flood")
    log._report_dropped(at_the_end=True)
    told = [line.text for line in lines if line.text != "flood"]
    assert [text.split()[0] for text in told] == ["2", "2", "2"]
    assert len(lines) == 9 + 3


def test_errors_are_never_dropped() -> None:
    lines: list[log_t] = []
    log = logger(lines, Wall())
    for number in range(20):
        log.info("flood")
        log.error(f"error {number}")
    assert [line.text for line in lines if line.level == log_t.ERROR] == [f"error {number}" for number in range(20)]
    assert len(lines) == 20 + 2


@pytest.mark.parametrize("letter", ["x", "é", "\N{ROBOT FACE}"])
def test_a_line_too_long_for_one_datagram_loses_its_middle(letter: str) -> None:
    lines: list[log_t] = []
    logger(lines, Wall()).error(f"begins {letter * 200_000} ends")
    (line,) = lines
    assert len(wire.datagrams(1, b"fwk/log", line.encode())) == 1
    assert line.text.startswith("begins ")
    assert line.text.endswith(" ends")
    assert f"{200_012 - 16_000} characters left out" in line.text


@pytest.mark.parametrize("text", ["\ud800 half a letter", "zero \0 inside", 17, None, b"bytes"])
def test_any_logged_object_can_be_sent(text: str) -> None:
    lines: list[log_t] = []
    logger(lines, Wall()).info(text)
    assert log_t.decode(lines[0].encode()).text == lines[0].text


def test_exception_has_its_traceback_and_place() -> None:
    lines: list[log_t] = []
    log = logger(lines, Wall())
    try:
        RateLimit.drop("no limit", 1)  # type: ignore[arg-type]
    except AttributeError as error:
        log.exception("cannot count", error)
    (line,) = lines
    assert line.file.endswith("test_component_log.py")  # the author's line, not the framework's
    assert line.text.startswith("cannot count\nTraceback (most recent call last):")
    assert line.text.endswith("AttributeError: 'str' object has no attribute '_dropped_now'")


class ChattyConfig(Config):
    gain: float = 1.0
    other: float = 1.0


class Chatty(Component):
    stage = "think"
    config: ChattyConfig
    log: Logger

    def init(self) -> None:
        self.told: list[frozenset[str]] = []

    def loop(self) -> None:
        self.log.debug("looped")

    def config_changed(self) -> None:
        self.told.append(self.changed_settings)


class Plain(Component):
    stage = "think"
    log: Logger


def test_the_level_is_a_setting_of_every_component() -> None:
    assert declaration(Plain).config().model_dump() == {"log_level": "info"}
    assert [line.text for line in _looped(log_level="debug")] == ["looped"]
    assert not _looped()


def _looped(log_level: str = "info") -> list[log_t]:
    bench = Bench(Chatty, log_level=log_level)
    bench.iterate()
    return bench.logged


def test_changed_log_level_counts_from_the_next_iteration() -> None:
    bench = Bench(Chatty)
    bench.iterate()
    bench.runner.configure({"gain": 1.0, "log_level": "debug"})
    bench.iterate()
    assert [line.tick for line in bench.logged] == [2]
    assert bench.component.told == []
    bench.runner.configure({"gain": 2.0, "other": 3.0, "log_level": "debug"})
    bench.runner.configure({"gain": 2.0, "other": 4.0, "log_level": "info"})
    assert bench.component.told == [{"gain", "other"}, {"other"}]


def test_the_name_of_the_level_setting_is_reserved() -> None:
    class Own(Config):
        log_level: int = 1

    class Double(Component):
        stage = "think"
        config: Own

    Double.__annotations__["config"] = Own
    with pytest.raises(DeclarationError, match="every component has a setting 'log_level'"):
        declaration(Double)


def test_levels_have_names_both_ways() -> None:
    assert {logging.LEVELS[name]: name for name in logging.LEVELS} == logging.LEVEL_NAMES
