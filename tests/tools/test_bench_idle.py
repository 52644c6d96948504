"""The least that the processes of a launch file need."""

import pytest

from fwk.engine.runner import Runner
from fwk.model.service_channels import is_of_service
from fwk.testing import system_of
from tools.bench import idle


def test_idle_components_write_one_empty_message_a_tick(monkeypatch: pytest.MonkeyPatch) -> None:
    """A component with several channels writes the first alone."""
    monkeypatch.setattr(Runner, "init", idle._init)
    system = system_of("soccer-1v1.yaml")
    system.tick(5)
    written = {channel: len(messages) for channel, messages in system.sent.items() if messages}
    assert written["world/field"] == written["cyan1/world_model"] == written["magenta1/pose"] == 5
    assert not {"world/ground_truth", "cyan1/team_message", "cyan1/obstacle_percepts"} & written.keys()
    assert not [channel for channel in written if is_of_service(channel)]
    assert system.newest("cyan1/world_model").localized is False
