"""An attribute that a component does not have: the error names the line or the word that is right."""

import copy
import pickle

import numpy as np
import pytest

import fwk
from fwk import Component, Config, Reads
from fwk.component.declaration import declaration
from fwk.component.undeclared import ANNOTATIONS
from fwk.testing.bench import Bench
from lcmtypes.robot import odometry_t


class PumpConfig(Config):
    gain: float = 0.5


class Bare(Component):
    stage = "think"


class Pump(Component):
    stage = "think"
    config: PumpConfig
    level: Reads[odometry_t]

    def init(self) -> None:
        self.pressure_pa = 0.0


class Hasty(Component):
    stage = "think"
    level: Reads[odometry_t]

    def __init__(self) -> None:
        self.level.value  # noqa: B018 - it fails


@pytest.mark.parametrize("attribute", [*sorted(ANNOTATIONS), "rng", "config"])
def test_an_aspect_without_its_annotation_names_the_line(attribute: str) -> None:
    with pytest.raises(AttributeError) as failure:
        getattr(Bare(), attribute)
    said = str(failure.value)
    assert said.startswith(f"'Bare' object has no attribute '{attribute}'; declare ")
    line = said.partition(f": {attribute}: ")[2].partition(" (")[0]
    names = {**vars(fwk), **{each: getattr(fwk, each) for each in fwk.__all__}, "np": np, "BareConfig": PumpConfig}
    annotation = eval(line, names)
    body = {"stage": "think", "__annotations__": {attribute: annotation}}
    read = declaration(type("Declared", (Component,), body))
    assert attribute in {*read.aspects, *read.asks, *(port.attribute for port in read.ports)} or attribute == "config"


@pytest.mark.parametrize(
    ("attribute", "right"),
    [
        ("levle", "did you mean 'level'?"),
        ("presure_pa", "did you mean 'pressure_pa'?"),
        ("gain", "it is a setting: config.gain"),
    ],
)
def test_a_misspelt_attribute_names_the_right_one(attribute: str, right: str) -> None:
    pump = Bench(Pump).component
    with pytest.raises(AttributeError, match=r"^'Pump' object has no attribute") as failure:
        getattr(pump, attribute)
    assert str(failure.value).endswith(f"; {right}")


def test_other_attributes_fail_as_in_python() -> None:
    bare = Bare()
    with pytest.raises(AttributeError, match=r"^'Bare' object has no attribute 'zzz'$"):
        bare.zzz  # type: ignore[attr-defined]  # noqa: B018 - mypy knows that it does not exist
    assert not hasattr(bare, "zzz")
    assert getattr(bare, "zzz", 5) == 5
    assert isinstance(copy.deepcopy(bare), Bare)
    assert isinstance(pickle.loads(pickle.dumps(bare)), Bare)


def test_ports_do_not_exist_yet_in_the_constructor() -> None:
    with pytest.raises(AttributeError, match="'level' yet; the framework sets it before init"):
        Hasty()
