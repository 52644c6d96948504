"""The iteration contract on real processes, checked against its definition."""

import os
import random
import signal
from pathlib import Path

import pytest

from fwk.model.tick_events import StageBegun, StageDone, events_of
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.oracle import contradictions
from tests.harness.runs import UNHURRIED, pause
from tests.programs.orchestra import PLAYERS, STAGES

pytestmark = pytest.mark.system

RUN = ("launch/orchestra.yaml", "--seed", "7", "--record", "log.lcm")
KILLS = 20


@pytest.mark.core
def test_every_iteration_sees_what_the_contract_says(launch: Launch, folder: Path) -> None:
    run = launch(*RUN, "--ticks", "40", env={"FWK_TEST_LOSS": "0.1"})
    assert run.wait() == 0, run.text
    recording = Recording(folder / "log.lcm")
    assert contradictions(recording) == []
    assert recording.gaps() == {}
    assert "repeated" in run.text  # ticks were lost, and yet no component ran twice:
    for player in PLAYERS:
        at = [(header.tick, header.stage) for header in recording.headers(f"{player}/note")]
        assert at == [(tick, stage) for tick in range(1, 41) for stage in STAGES[player]]
    assert [look.lost for look in recording.decoded("a/look")] == [0] * 40
    assert all(look.digest >= 0 for look in recording.decoded("a/look"))


def test_tick_records_hold_the_order_of_the_main_loop(launch: Launch, folder: Path) -> None:
    run = launch(*RUN, "--ticks", "10")
    assert run.wait() == 0, run.text
    recording = Recording(folder / "log.lcm")
    names = sorted(recording.messages)
    for record in recording.records:
        stages, running = [], -1
        for event in events_of(record.events):
            if isinstance(event, StageBegun):
                running = event.stage
                stages.append(running)
            elif isinstance(event, StageDone):
                assert (event.tick, event.step) == (record.tick, running)
        assert stages == sorted(stages)
        marks = {names[channel]: sequence for channel, sequence in zip(record.channel, record.sequence, strict=True)}
        for name in names:
            written = [header.sequence for header in recording.headers(name) if header.tick == record.tick]
            assert marks.get(name) == (written[-1] if written else None)


@pytest.mark.parametrize("moment", ["loop:kill", "loop:kill after publish", "loop:raise"])
def test_messages_of_a_dying_iteration_are_never_seen(launch: Launch, folder: Path, moment: str) -> None:
    run = launch(*RUN, "--ticks", "30", "--set", f"d/player.trouble={moment}", "--set", "d/player.trouble_tick=15")
    assert run.wait() == 0, run.text
    assert "d/player ended: " in run.text
    assert "d/player runs again, incarnation 2" in run.text
    assert "lost 0" in run.text
    recording = Recording(folder / "log.lcm")
    assert contradictions(recording) == []
    assert recording.gaps() == {}
    writers = [header.writer for header in recording.headers("d/note")]
    assert writers == ["d/player"] * 14 + ["d/player#2"] * 16


@pytest.mark.parametrize("hosting", ["process", "robot", "single"])
def test_death_between_two_stages_keeps_the_own_last_message(launch: Launch, folder: Path, hosting: str) -> None:
    trouble = {"trouble": "loop:kill after publish", "trouble_tick": 15, "trouble_stage": "act"}
    sets = [word for key, value in trouble.items() for word in ("--set", f"a/player.{key}={value}")]
    run = launch(*RUN, "--ticks", "20", "--hosting", hosting, *sets)
    assert run.wait() == 0, run.text
    assert "lost 0" in run.text
    recording = Recording(folder / "log.lcm")
    assert contradictions(recording) == []
    assert recording.gaps() == {}
    first = next(note for note in recording.decoded("a/note") if note.header.writer == "a/player#2")
    own = next(heard for heard in first.heard if heard.channel == "a/note")
    assert (first.header.tick, first.header.stage) == (15, STAGES["a"][1])
    assert (own.count, own.newest_tick, own.newest_stage) == (1, 15, STAGES["a"][0])


@pytest.mark.slow
def test_kills_at_any_time_duplicate_and_lose_no_message(launch: Launch, folder: Path) -> None:
    (folder / "traces").mkdir()
    file = folder / "launch/orchestra.yaml"
    use = 'use: "player:Player"'
    file.write_text(file.read_text().replace(use, f"{use}, restart: {{ backoff_s: 0.01, limit: 100 }}"))
    run = launch(*RUN, *UNHURRIED)
    luck = random.Random(1)
    for kills in range(KILLS):
        run.until_count(" runs again", kills)
        # Two ticks without a death: a message that died with its writer before a newcomer could fetch it is lost.
        run.until_ticks("f/player", 3)
        pause(luck.uniform(0.0, 0.1))
        os.kill(run.host(f"{luck.choice(PLAYERS)}/player"), signal.SIGKILL)
    run.until_count(" runs again", KILLS)
    run.signal(signal.SIGINT)
    assert run.wait() == 0, run.text
    recording = Recording(folder / "log.lcm")
    assert contradictions(recording) == []
    assert recording.gaps() == {}
    writers = {header.writer for player in PLAYERS for header in recording.headers(f"{player}/note")}
    assert len(writers) > len(PLAYERS)
