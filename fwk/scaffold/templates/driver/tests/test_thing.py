"""The driver obeys commands and stops without them."""

from pathlib import Path

from fwk.testing import Bench
from things.thing import Thing


def test_thing_obeys_and_stops_without_commands() -> None:
    bench = Bench(Thing, command_timeout_s=0.1)
    bench.thing_command.put(power=3.0)
    bench.iterate(5)
    assert bench.thing.sent[0].power == 1.0
    assert bench.thing.sent[-1].power == 0.0
    assert sum("no command" in line.text for line in bench.logged) == 1


def test_thing_leaves_its_device_stopped(tmp_path: Path) -> None:
    device = tmp_path / "device"
    device.touch()
    bench = Bench(Thing, device=str(device))
    bench.thing_command.put(power=0.5)
    bench.iterate()
    bench.finalize()
    assert device.read_text().split() == ["0.500", "0.000"]
