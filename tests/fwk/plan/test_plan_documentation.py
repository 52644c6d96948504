"""The documentation of launch files names every key that exists."""

import re
from pathlib import Path
from typing import Any

import pytest
from pydantic import TypeAdapter

from fwk.component.component import DEFAULT_STAGES
from fwk.model.sections import LogPlan, RestartPolicy
from fwk.plan.files.schema import ComponentEntry, LaunchFile, RobotEntry

TEXT = (Path(__file__).parents[3] / "docs" / "launch-file.md").read_text()


@pytest.mark.parametrize("model", [LaunchFile, ComponentEntry, RobotEntry, RestartPolicy, LogPlan])
def test_every_key_is_there(model: type[Any]) -> None:
    words = set(re.findall(r"`(\w+)`", TEXT))
    assert set(TypeAdapter(model).json_schema()["properties"]) <= words


def test_the_default_stages_are_there_in_their_order() -> None:
    assert ", ".join(DEFAULT_STAGES) in TEXT
