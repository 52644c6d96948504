"""The world model that knows the truth."""

from fwk.testing import Bench
from lcmtypes.soccer import pass_agreement_t, true_robot_t
from procs.model.robot import ABSENT
from procs.scenarios.perfect_world import PerfectWorldModel

PERIOD_S = 0.05


def test_mates_have_the_roles_that_they_announce() -> None:
    bench = Bench(PerfectWorldModel, "cyan1/world_model", namespaces=("cyan3",))
    names = ("cyan1", "magenta1", "cyan2", "cyan3")
    robots = [true_robot_t(name=name, team=name[:-1], number=int(name[-1]), x_m=1.0 * place, vy_m_s=0.5)
              for place, name in enumerate(names)]  # fmt: skip
    bench.port("ground_truth").put(robots=robots)
    bench.port("role", "cyan3").put(role="passer")
    bench.iterate()
    model = bench.port("world_model").sent[-1]
    assert [(each.name, each.x_m, each.role) for each in model.mates] == [
        ("cyan2", 2.0, ABSENT),
        ("cyan3", 3.0, "passer"),
    ]
    assert [(each.x_m, each.vy_m_s) for each in model.opponents] == [(1.0, 0.5)]


def test_mate_whose_agent_is_silent_does_not_play() -> None:
    bench = Bench(PerfectWorldModel, "cyan1/world_model", namespaces=("cyan2",))
    bench.port("ground_truth").put(robots=[true_robot_t(name=name, team="cyan") for name in ("cyan1", "cyan2")])
    agreement = pass_agreement_t(receiver="cyan1")
    bench.port("role", "cyan2").put(role="attacker", agreement=agreement)
    for silent_s, role, receiver in ((1.9, "attacker", "cyan1"), (0.3, ABSENT, "")):
        bench.iterate(round(silent_s / PERIOD_S))
        (mate,) = bench.port("world_model").sent[-1].mates
        assert (mate.role, mate.agreement.receiver) == (role, receiver)
