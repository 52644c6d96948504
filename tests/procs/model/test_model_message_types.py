"""Message types of robot and match cannot be mistaken for each other."""

from fwk.lcm import messages
from fwk.lcm.type_registry import by_fingerprint

PACKAGES = ("core.", "robot.", "soccer.")


def test_each_type_has_a_fingerprint_of_its_own() -> None:
    """LCM leaves a struct's name out of the fingerprint: with equal members a swapped channel would decode."""
    names = [[messages.type_name(each) for each in found] for found in by_fingerprint().values()]
    ours = [[name for name in found if name.startswith(PACKAGES)] for found in names]
    assert any(ours)
    assert [found for found in ours if len(found) > 1] == []
