"""Further faults of a component."""

import os
import subprocess
import sys
import threading
from pathlib import Path

from fwk.clock import sleep_s


class HostileError(Exception):
    def __str__(self) -> str:
        raise RuntimeError("no text")


def long_text() -> None:
    raise RuntimeError("x" * 200_000)


def no_text() -> None:
    raise RuntimeError("no text \udcff\0 at all")


def no_words() -> None:
    raise HostileError


def deep() -> None:
    deep()


def leave_in_thread() -> None:
    threading.Thread(target=lambda: os._exit(0)).start()
    sleep_s(60)


def close_all() -> None:
    os.closerange(3, 100)


def child_and_die() -> None:
    child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
    Path("child").write_text(str(child.pid))
    os.kill(os.getpid(), 9)


MORE = {
    "long text": long_text,
    "no text": no_text,
    "no words": no_words,
    "deep": deep,
    "leave in a thread": leave_in_thread,
    "close all": close_all,
    "child and die": child_and_die,
}
