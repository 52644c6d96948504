"""Work done before processes are forked: codecs of all channels, and shared data of classes, once for each setting."""

from typing import ClassVar

import pytest

from fwk.component.channels import Reads, Writes
from fwk.component.component import Component
from fwk.component.config import Config
from fwk.lcm import codec
from fwk.lcm.messages import type_named
from fwk.supervisor.processes.preload import preload
from fwk.testing.plans import plan_of
from lcmtypes.robot import imu_t


class TablesConfig(Config):
    """One setting that a table depends on."""

    size: int = 1


class Tables(Component):
    """Has a table that all components of the class can share."""

    stage = "think"
    imu: Writes[imu_t]
    config: TablesConfig
    made: ClassVar[list[int]] = []

    @classmethod
    def preload(cls, config: TablesConfig) -> None:
        if config.size < 0:
            raise ValueError(config.size)
        cls.made.append(config.size)


class Looks(Component):
    """Reads a channel."""

    stage = "act"
    imu: Reads[imu_t]


@pytest.fixture(autouse=True)
def forget_tables() -> None:
    Tables.made.clear()


def test_codecs_exist_before_any_process_needs_them() -> None:
    codec.decoder.cache_clear()
    codec.encoder.cache_clear()
    preload(plan_of({"r/tables": Tables, "r/looks": Looks}, channels={"r/looks": {"imu": "r/imu"}}))
    made = codec.decoder.cache_info().misses, codec.encoder.cache_info().misses
    codec.decoder(type_named("robot.imu_t"))
    codec.encoder(type_named("robot.imu_t"))
    assert (codec.decoder.cache_info().misses, codec.encoder.cache_info().misses) == made


def test_class_is_asked_once_for_equal_settings() -> None:
    preload(plan_of({f"r{i}/tables": Tables for i in range(4)}, {"r3/tables": {"size": 2}}))
    assert Tables.made == [1, 2]


def test_a_class_that_fails_is_left_to_its_own_init() -> None:
    preload(plan_of({"r/tables": Tables, "s/tables": Tables}, {"r/tables": {"size": -1}}))
    assert Tables.made == [1]
