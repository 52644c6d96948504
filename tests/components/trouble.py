"""Faults that a component can be told to have."""

import ctypes
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fwk.clock import sleep_s
from fwk.host.outputs import Outputs


def fail() -> None:
    raise RuntimeError("a wrong note")


class GiveUp(BaseException):
    pass


def give_up() -> None:
    raise GiveUp("no more")


def spin() -> None:
    while True:
        pass


def kill() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def kill_after_publish() -> None:
    publish = Outputs.publish

    def publish_and_die(self: Outputs, written: Any) -> Any:
        publish(self, written)
        kill()

    Outputs.publish = publish_and_die  # type: ignore[method-assign]


def wait() -> None:
    while not Path("go-on").exists():
        sleep_s(0.01)


def ignore() -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    Path("ignoring").touch()
    while True:
        sleep_s(0.01)


def print_much() -> None:
    print("words on standard output")
    print("words on standard error", file=sys.stderr)


MAKE: dict[str, Callable[[], object]] = {
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
