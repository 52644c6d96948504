"""Speed of the physics alone."""

from tools.bench.physics import seconds_of


def test_physics_of_a_match_has_its_cpu_time() -> None:
    assert seconds_of(0.005, match_s=0.2, fight=True) > 0
