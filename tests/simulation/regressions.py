"""Minimal histories that once broke a promise of the contract, each named after the defect."""

from tests.simulation.faults import Action, Weather
from tests.simulation.scenario import Part, Scenario

REGRESSIONS: dict[str, Scenario] = {
    # A host died before the gateway had its last message, and nobody answered at its port until it was started again;
    # but at the end of a run, and while the main loop waits for the gateway, nobody starts it again.
    "gateway asks a dead host while the loop waits for it": Scenario(
        seed=1,
        ticks=3,
        parts=(Part("b0/player", "Player"), Part("c1/player", "Player")),
        stages=("think",),
        weather=Weather(loss=0.3),
        actions=(Action("kill", after_tick=3, delay_us=20, target="b0/player"),),
    ),
    # A reader that fetched did not read channels that were complete already, but still waited for them: a message that
    # came there later, such as one that was sent twice, ended every wait at once until the fetch was over.
    "reader spins while it fetches": Scenario(
        seed=1,
        ticks=5,
        parts=(Part("b0/player", "Player"), Part("c1/player", "Player")),
        stages=("think",),
        weather=Weather(loss=0.3),
    ),
}
