"""The documentation of launch files names every key that there is."""

import re
from pathlib import Path

import pytest
from pydantic import BaseModel

from fwk.component.component import DEFAULT_STAGES
from fwk.plan.files.schema import ComponentEntry, LaunchFile, LogEntry, RestartEntry, RobotEntry

TEXT = (Path(__file__).parents[3] / "docs" / "launch-file.md").read_text()


@pytest.mark.parametrize("model", [LaunchFile, ComponentEntry, RobotEntry, RestartEntry, LogEntry])
def test_every_key_is_there(model: type[BaseModel]) -> None:
    words = set(re.findall(r"`(\w+)`", TEXT))
    assert set(model.model_fields) <= words


def test_the_default_stages_are_there_in_their_order() -> None:
    assert ", ".join(DEFAULT_STAGES) in TEXT
