"""Every component of `procs` starts, survives silence, old data and extreme values, and closes."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fwk import Component
from fwk.testing import Bench
from procs.refbox.server import RefBoxServer
from procs.vision.calibration import MirrorConfig
from tests.conformance.discovery import discovered, label, usage
from tests.conformance.messages import Filling, extremes, usual
from tests.procs.vision.picture_parts import shades, write_folder

NAMESPACES = ("cyan1", "cyan2", "magenta1")
SILENT_TICKS = 40
SIZE_PX = MirrorConfig().size_px

COMPONENTS = pytest.mark.parametrize("component", discovered(), ids=label)


@pytest.fixture(autouse=True)
def pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Provides the folder `pictures`, from which `vision.yaml` takes its frames."""
    write_folder(tmp_path / "pictures", shades(3, SIZE_PX, SIZE_PX))
    monkeypatch.chdir(tmp_path)


def bench_of(component: type[Component]) -> Bench:
    """Returns the component on a bench, with the settings of the first launch file that contains it."""
    used = usage(component)
    settings = dict(used[1].config) if used else {}
    if component is RefBoxServer:
        settings["port"] = 0  # a free one: several tests have a server at the same time
    return Bench(component, name="cyan1/component", namespaces=NAMESPACES, **settings)


def put(bench: Bench, filling: Filling) -> None:
    """Makes a message or a frame visible at each input of the component."""
    for port in bench.declaration.ports:
        for namespace in NAMESPACES if port.each else ("",):
            if port.images and not port.writes:
                shade = filling.message(port.message_type).frame % 256
                bench.show(
                    port.attribute,
                    np.full((SIZE_PX, SIZE_PX, 3), shade, np.uint8),
                    namespace,
                )
            elif not port.writes and not port.sends:
                outside = bench.port(port.attribute, namespace)
                outside.put(filling.message(outside.message_type))


def numbers(value: Any) -> Iterator[float]:
    """Yields all floating-point numbers of a message, of its members and its lists."""
    if isinstance(value, float):
        yield value
    elif isinstance(value, list | tuple):
        for each in value:
            yield from numbers(each)
    elif hasattr(value, "__slots__") and not isinstance(value, bytes):
        for name in value.__slots__:
            yield from numbers(getattr(value, name))


def not_finite(bench: Bench) -> set[str]:
    """Returns the channels on which the component has written a number that is infinite or not a number."""
    found = set()
    for port in bench.declaration.ports:
        for namespace in NAMESPACES if port.each and port.writes else [""] if port.writes else []:
            outside = bench.port(port.attribute, namespace)
            if not all(math.isfinite(number) for message in outside.sent for number in numbers(message)):
                found.add(outside.channel)
    return found


def test_components_are_discovered() -> None:
    found = {label(each) for each in discovered()}
    assert {"simulation.simulator", "vision.omni_ball", "behaviour.agent", "world_model.ball_spot"} <= found


@COMPONENTS
def test_a_component_starts_and_closes(component: type[Component]) -> None:
    bench = bench_of(component)
    bench.finalize()
    assert not_finite(bench) == set()


@COMPONENTS
def test_a_component_survives_silence(component: type[Component]) -> None:
    bench = bench_of(component)
    bench.iterate(SILENT_TICKS)
    bench.finalize()
    assert not_finite(bench) == set()


@COMPONENTS
def test_a_component_survives_old_data(component: type[Component]) -> None:
    """Inputs fall silent after one message; later a message arrives that was stamped before all others."""
    bench = bench_of(component)
    filling = usual()
    put(bench, filling)
    bench.iterate(SILENT_TICKS)
    put(bench, filling)
    bench.iterate(2)
    bench.finalize()
    assert not_finite(bench) == set()


@COMPONENTS
def test_a_component_survives_extreme_values(component: type[Component]) -> None:
    bench = bench_of(component)
    for filling in extremes():
        put(bench, filling)
        bench.iterate(2)
    put(bench, usual())
    bench.iterate(2)
    bench.finalize()
