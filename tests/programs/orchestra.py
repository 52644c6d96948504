"""A small system that uses all of the contract at once: what its players heard stands in what they write.

Six players in five stages hear everybody, themselves too; `d` and `e` are peers of one stage, `a` takes part in two.
Each writes one note an iteration and none to three bursts; `b`'s bursts are larger than a datagram. The conductor is
the time source, its ticks are not equally long. A camera gives out frames, a viewer looks at them. A player can be told
to make trouble (`TROUBLE`), and all processes to lose datagrams (`WEATHER`).
"""

TYPES = """
package play;

struct heard_t {
  string  channel;
  int64_t first;         // sequence numbers since the last iteration; 0: none
  int64_t last;
  int64_t count;
  int64_t newest_tick;   // of the newest message
  int16_t newest_stage;
}

struct note_t {
  core.header_t header;
  int64_t iterations;    // of this process
  int64_t digest;        // of everything ever heard
  boolean frozen;        // inputs were the same at the beginning and the end of the iteration
  int32_t n;
  heard_t heard[n];
}

struct burst_t {
  core.header_t header;
  int32_t n;
  byte    ballast[n];
}

struct look_t {
  core.header_t header;
  int64_t frame;
  int64_t digest;        // of the pixels; -1: none
  int64_t lost;
}
"""

PLAYER = '''
"""Writes down what it heard."""

import os
import zlib
from pathlib import Path

import numpy as np
import procs.weather
from procs import trouble

from fwk import Clock, Component, Config, ReadsEach, TimeSource, Writes, channel
from lcmtypes.play import burst_t, heard_t, note_t


class PlayerConfig(Config):
    bursts: int = 3
    """Most bursts of an iteration."""
    ballast: int = 50
    """Bytes of the largest burst."""
    work: int = 0
    """Rounds of pointless work in an iteration."""
    tone: int = 0
    """Goes into the digest."""
    trouble: str = ""
    """What goes wrong, see procs/trouble.py."""
    trouble_tick: int = 0
    """From when on, if not in init or finalize."""
    trouble_stage: str = ""
    """In which stage; the first if empty."""
    trouble_again: bool = False
    """Also when the player was started again."""


class Player(Component):
    """Hears everybody."""

    stage = "think"

    config: PlayerConfig
    clock: Clock
    rng: np.random.Generator
    notes: ReadsEach[note_t] = channel("*/note")
    bursts: ReadsEach[burst_t] = channel("*/burst")
    note: Writes[note_t]
    burst: Writes[burst_t]

    def init(self) -> None:
        self.leave_trace("pid", os.getpid())
        self.make_trouble("init")
        self.note.value.digest = self.config.tone

    def loop(self) -> None:
        note = self.note.value
        note.iterations += 1
        self.leave_trace("tick", self.clock.tick)
        before = self.digest()
        note.heard = [self.heard(reader) for _, reader in (*self.notes.items(), *self.bursts.items())]
        for _ in range(self.config.work):
            zlib.crc32(bytes(100_000))
        note.frozen = before == self.digest()
        note.digest = zlib.crc32(before.to_bytes(8, "big"), note.digest)
        self.note.write()
        for _ in range(self.rng.integers(self.config.bursts + 1)):
            self.burst.value.ballast = self.rng.bytes(self.config.ballast)
            self.burst.write()
        if self.clock.tick >= self.config.trouble_tick > 0 and self.config.trouble_stage in ("", self.clock.stage):
            self.make_trouble("loop")

    def finalize(self) -> None:
        self.make_trouble("finalize")

    def leave_trace(self, kind: str, number: int) -> None:
        if Path("traces").is_dir():
            new = Path("traces", f"{self.name.replace('/', '_')}.{kind}.new")
            new.write_text(str(number))
            new.rename(new.with_suffix(""))

    def make_trouble(self, where: str) -> None:
        done = Path("trouble-" + self.name.replace("/", "_"))
        if self.config.trouble.startswith(where + ":") and (self.config.trouble_again or not done.exists()):
            done.touch()
            trouble.MAKE[self.config.trouble.partition(":")[2]]()

    def digest(self) -> int:
        found = 0
        for _, reader in (*self.notes.items(), *self.bursts.items()):
            for message in reader.fresh:
                found = zlib.crc32(message.encode(), found)
            found = zlib.crc32(reader.value.encode(), found)
        return found

    def heard(self, reader):
        made, numbers = heard_t(), [message.header.sequence for message in reader.fresh]
        made.channel, made.count = reader.channel, len(numbers)
        made.first, made.last = (numbers[0], numbers[-1]) if numbers else (0, 0)
        made.newest_tick, made.newest_stage = reader.header.tick, reader.header.stage
        return made


class Conductor(Component):
    """Says when the next tick is."""

    stage = "pre_loop"

    clock: Clock
    rng: np.random.Generator
    time_source: TimeSource

    def loop(self) -> None:
        self.time_source.next_us = self.clock.now_us + int(self.rng.integers(30_000, 70_000))
'''

VISION = '''
"""A camera and who looks at its frames."""

import zlib

import numpy as np

from fwk import Component, Image, VisionMaster, Writes
from lcmtypes.play import look_t


class Camera(Component):
    """One to three frames of noise an iteration."""

    stage = "sensor_acquire"

    rng: np.random.Generator
    image: VisionMaster

    def loop(self) -> None:
        for _ in range(self.rng.integers(1, 4)):
            self.image.publish(self.rng.integers(256, size=(48, 64, 3), dtype=np.uint8))


class Viewer(Component):
    """Looks at the newest."""

    stage = "sensor_process"

    image: Image
    look: Writes[look_t]

    def loop(self) -> None:
        pixels = self.image.pixels
        self.look.value.frame = self.image.announcement.value.frame
        self.look.value.digest = -1 if pixels is None else zlib.crc32(pixels.tobytes())
        self.look.value.lost = self.image.lost
        self.look.write()
'''

TROUBLE = '''
"""What can go wrong in a component."""

import ctypes
import os
import signal
import sys
import time
from pathlib import Path

from fwk.host.outputs import Outputs


def fail():
    raise RuntimeError("a wrong note")


class GiveUp(BaseException):
    pass


def give_up():
    raise GiveUp("no more")


def spin():
    while True:
        pass


def kill():
    os.kill(os.getpid(), signal.SIGKILL)


def kill_after_publish():
    publish = Outputs.publish

    def publish_and_die(self, written):
        publish(self, written)
        kill()

    Outputs.publish = publish_and_die


def wait():
    while not Path("go-on").exists():
        time.sleep(0.01)


def ignore():
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    Path("ignoring").touch()
    while True:
        time.sleep(0.01)


def print_much():
    print("words on standard output")
    print("words on standard error", file=sys.stderr)


MAKE = {
    "raise": fail,
    "exit": lambda: sys.exit(0),
    "exit text": lambda: sys.exit("enough"),
    "os._exit": lambda: os._exit(3),
    "leave": lambda: os._exit(0),
    "give up": give_up,
    "spin": spin,
    "kill": kill,
    "kill after publish": kill_after_publish,
    "crash": lambda: ctypes.string_at(0),
    "wait": wait,
    "ignore": ignore,
    "print": print_much,
}
'''

WEATHER = '''
"""Bad weather for the processes that import this: datagrams get lost at the sender, buffers are small."""

import os
import random

from fwk.bus import network, sockets

loss = float(os.environ.get("FWK_TEST_LOSS", "0"))
buffer_bytes = int(os.environ.get("FWK_TEST_BUFFER_BYTES", "0"))

if loss:

    class _Lossy:
        def __init__(self, real):
            self._real = real
            self._luck = random.Random(real.getsockname()[1])

        def sendto(self, datagram, address):
            if self._luck.random() >= loss:
                self._real.sendto(datagram, address)

        def __getattr__(self, name):
            return getattr(self._real, name)

    _calm = network.UdpNetwork.own_socket
    network.UdpNetwork.own_socket = lambda self, port: _Lossy(_calm(self, port))

if buffer_bytes:
    sockets.multicast_receiver.__defaults__ = (buffer_bytes,)
'''

LAUNCH = """
name: orchestra
speed: max
components:
  world/conductor: {{ use: "procs.player:Conductor" }}
  a/player: {{ use: "procs.player:Player", stage: [sensor_prepare, act] }}
  b/player: {{ use: "procs.player:Player", stage: sensor_acquire, config: {{ ballast: 100000 }} }}
  c/player: {{ use: "procs.player:Player", stage: worldstate }}
  d/player: {{ use: "procs.player:Player" }}
  e/player: {{ use: "procs.player:Player", config: {{ work: 5 }} }}
  f/player: {{ use: "procs.player:Player", stage: post_loop }}
  a/camera: {{ use: "procs.vision_parts:Camera" }}
  a/viewer: {{ use: "procs.vision_parts:Viewer" }}
public_url: "{public_url}"
"""

PLAYERS = "abcdef"
STAGES = {"a": (2, 7), "b": (1,), "c": (4,), "d": (5,), "e": (5,), "f": (9,)}
"""Player to the indices of its stages."""

GROUPS = """
hosts:
  strings: [a/player, c/player, e/player]
  brass: [b/player, a/camera, world/conductor]
"""


def orchestra(public_url: str, more: str = "") -> dict[str, str]:
    """The files of a user's folder; `more` is added to the launch file."""
    return {
        "lcmtypes/play.lcm": TYPES,
        "procs/player.py": PLAYER,
        "procs/vision_parts.py": VISION,
        "procs/trouble.py": TROUBLE,
        "procs/weather.py": WEATHER,
        "launch/orchestra.yaml": LAUNCH.format(public_url=public_url) + more,
    }
