"""The system clock is set back an hour during a run: only the wall times in the log show it."""

import json
import signal
import subprocess
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest

from tests.faults.aftermath import Aftermath
from tests.faults.conftest import RUN
from tests.harness.fixtures import Launch

pytestmark = pytest.mark.system

TALK = (
    "--set",
    "d/player.trouble=loop:print",
    "--set",
    "d/player.trouble_tick=1",
    "--set",
    "d/player.trouble_again=true",
)

CLOCK = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static int set_back(void) { return access("set-back", F_OK) == 0; }

int clock_gettime(clockid_t clock, struct timespec *now) {
  static int (*real)(clockid_t, struct timespec *);
  if (!real) real = dlsym(RTLD_NEXT, "clock_gettime");
  int failed = real(clock, now);
  if (clock == CLOCK_REALTIME && set_back()) now->tv_sec -= 3600;
  return failed;
}

int gettimeofday(struct timeval *now, void *zone) {
  struct timespec exact;
  clock_gettime(CLOCK_REALTIME, &exact);
  now->tv_sec = exact.tv_sec;
  now->tv_usec = exact.tv_nsec / 1000;
  return 0;
}

time_t time(time_t *out) {
  struct timespec exact;
  clock_gettime(CLOCK_REALTIME, &exact);
  if (out) *out = exact.tv_sec;
  return exact.tv_sec;
}
"""


@pytest.fixture
def clock(wall: Path, needs: Callable[..., None]) -> dict[str, str]:
    """An environment in which the file `set-back` sets the clock back."""
    needs("cc")
    source, library = wall / "clock.c", wall / "clock.so"
    source.write_text(CLOCK)
    subprocess.run(["cc", "-shared", "-fPIC", "-o", library, source, "-ldl"], check=True)
    return {"LD_PRELOAD": str(library)}


def test_setting_the_clock_back_changes_no_logical_time(
    launch: Launch, wall: Path, after: Aftermath, clock: dict[str, str]
) -> None:
    run = launch(*RUN, *TALK, env=clock)
    run.until_ticks("f/player", 10)
    after.note(run)
    before = run.tick("f/player")
    (wall / "set-back").touch()
    run.until_ticks("f/player", 20)
    run.signal(signal.SIGINT)
    recording = after.check(run)
    assert recording.gaps() == {}
    times = [record.time_us for record in recording.records]
    assert len(times) >= before + 20
    assert all(later - earlier > 0 for earlier, later in pairwise(times))
    assert times[-1] < 60 * 60 * 1_000_000  # nor did the clock jump ahead
    lines = (run.run_dir / "fwk.log.jsonl").read_text().splitlines()
    walls = [json.loads(line)["wall_us"] for line in lines]
    assert any(later < earlier - 3_000_000_000 for earlier, later in pairwise(walls)), "it was set back, as people see"
