"""Counts the messages on `a/note`; on a probe it writes the probe and the count to a file: subscriber.py URL FILE."""

import sys
from pathlib import Path

import lcm


def main(url: str, file: Path) -> None:
    """Counts until it is killed."""
    bus = lcm.LCM(url)
    heard: list[bytes] = []
    bus.subscribe("a/note", lambda _, data: heard.append(data))

    def answer(_: str, data: bytes) -> None:
        file.write_text(f"{data.decode()} {len(heard)}")

    bus.subscribe("fwk/probe", answer)
    while True:
        bus.handle()


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
