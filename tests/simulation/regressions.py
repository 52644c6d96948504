"""Minimal histories that once broke a promise of the contract, each named after the defect."""

from tests.simulation.faults import Action, Weather
from tests.simulation.scenario import Part, Scenario

REGRESSIONS: dict[str, Scenario] = {
    # A host died before the gateway had its last message, and no process answered at its port until the restart;
    # but at the end of a run, and while the main loop waits for the gateway, no restart happens.
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
    # A continuous component that is slower than the ticks got the mark of a channel that it had opened with an earlier
    # tick than the newest one, and only the marks of the newest tick counted for the new channel.
    "slow component opens a channel": Scenario(
        seed=346,
        ticks=22,
        parts=(
            Part("drift1/rover", "Rover", (), {"bursts": 3, "early": False}),
            Part("b4/opener", "Opener", ("think",), {"ballast": 20, "eager": 0.3, "early": False}),
            Part("a5/opener", "Opener", ("plan",), {"ballast": 20, "bursts": 3, "eager": 0.8, "work_us": 500}),
            Part("drift6/drifter", "Drifter", (), {"ballast": 20, "eager": 0.1}),
        ),
        stages=("plan", "think"),
        period_us=10_000,
        weather=Weather(delay=0.1754, delay_us=24_142),
        actions=(Action("steer", 15, 818, "drift6/drifter", word="stop"),),
    ),
    # In lockstep a process that took more than 20 s to become ready was killed, at the start as after a restart.
    "slow start in lockstep": Scenario(
        seed=5,
        ticks=8,
        parts=(
            Part("b0/player", "Player", ("think",), {"crash_tick": 4, "crash_in": "loop"}),
            Part("c1/director", "Director", ("think",), {"eager": 0.8}),
            Part("c2/opener", "Opener", ("think",), {"eager": 0.8}),
        ),
        stages=("think",),
        weather=Weather(slow_start_us=90_000_000),
    ),
    # A host that was asked to stop before it was ready had taken no part, but what it wrote in `finalize` counted and
    # no replay could write it again.
    "host stops before it is ready": Scenario(
        seed=3,
        ticks=40,
        parts=(Part("b0/player", "Player"), Part("c1/player", "Player")),
        stages=("think",),
        wall=True,
        weather=Weather(slow_start_us=400_000),
        actions=(Action("kill", 20, 20, "b0/player"), Action("steer", 22, 0, "b0/player", word="stop")),
    ),
    # A component that failed took its process along, and with it the messages of earlier iterations that had been lost
    # on their way.
    "component fails after lost messages": Scenario(
        seed=18,
        ticks=5,
        parts=(Part("a4/opener", "Opener", ("think", "tidy"), {"crash_tick": 5, "eager": 0.8}),),
        stages=("plan", "think", "act", "tidy"),
        period_us=10_000,
        weather=Weather(loss=0.13),
    ),
    # A component asked twice for a channel before it iterated again; in a replay the second decision dropped the
    # messages that had been kept for the first.
    "slow component opens a channel twice": Scenario(
        seed=566,
        ticks=8,
        parts=(
            Part("c1/player", "Player", ("think",), {"ballast": 20, "bursts": 3, "work_us": 500}),
            Part("c3/opener", "Opener", ("plan",), {"bursts": 0}),
            Part("drift4/rover", "Rover", (), {"ballast": 20, "bursts": 3, "eager": 0.8, "work_us": 30_000}),
        ),
        stages=("plan", "think"),
        weather=Weather(
            latency_us=200,
            loss=0.0004,
            delay=0.0364,
            delay_us=37_854,
            slow_start_us=1_998_800,
            hiccup=0.0851,
            hiccup_us=18_166,
        ),
        actions=(Action("set", 3, 14_420, "drift4/rover", 969_730),),
    ),
    # A continuous component asked for a channel while a boundary waited for a host that left: the run decided that at
    # the next boundary, the branch of its recording at once.
    "branch decides what came during the boundary": Scenario(
        seed=5075,
        ticks=6,
        parts=(
            Part("a0/director", "Director", ("act",), {"ballast": 20, "eager": 0.8}),
            Part("b2/opener", "Opener", ("act",)),
            Part("drift3/rover", "Rover", ()),
        ),
        stages=("plan", "think", "act"),
        actions=(Action("stop", after_tick=2, delay_us=76, target="gateway", amount=103_055),),
    ),
    # The host of the component with the main loop died at a boundary after the decision about the main loop; the branch
    # decided afterwards, gave the main loop back a tick earlier than the run, and no longer followed it.
    "branch decides the main loop too late": Scenario(
        seed=5473,
        ticks=6,
        parts=(
            Part("drift2/drifter", "Drifter", (), {"ballast": 20}),
            Part("b3/usurper", "Usurper", ("plan",), {"bursts": 0}),
            Part(
                "b4/opener",
                "Opener",
                ("plan", "think"),
                {"ballast": 20, "bursts": 3, "crash_in": "loop", "crash_tick": 7, "eager": 0.3, "early": True},
            ),
            Part(
                "b5/opener",
                "Opener",
                ("plan", "tidy"),
                {
                    "ballast": 20,
                    "bursts": 3,
                    "crash_in": "loop",
                    "crash_tick": 6,
                    "eager": 0.3,
                    "early": False,
                    "work_us": 0,
                },
            ),
            Part(
                "b6/opener",
                "Opener",
                ("think", "act"),
                {"ballast": 20, "bursts": 0, "eager": 0.1, "early": False, "work_us": 0},
            ),
        ),
        stages=("plan", "think", "act", "tidy"),
        hosting="robot",
        weather=Weather(loss=0.0627),
        actions=(
            Action("kill_at_send", after_tick=2, delay_us=17_735, target="drift2/drifter", amount=9),
            Action("cut_off", after_tick=3, delay_us=14_628, target="b4/opener", amount=19),
        ),
    ),
    # The machine stood still for four seconds while a host left. The host gave up waiting for the gateway, which had no
    # time to fetch its last messages.
    "machine stands still while a host leaves": Scenario(
        seed=20079,
        ticks=4,
        parts=(
            Part("a0/usurper", "Usurper", ("sense", "think"), {"eager": 0.8}),
            Part("b2/director", "Director", ("tidy",), {"ballast": 20, "bursts": 3, "eager": 0.8}),
        ),
        stages=("sense", "think", "tidy"),
        period_us=10_000,
        weather=Weather(loss=0.2565, duplicate=0.0281, hiccup=0.0257),
        actions=(Action("jump", after_tick=3, delay_us=426, target="b2/director", amount=4_285_757),),
    ),
    # A component raised in a stage that its host had run ahead. The process ended before the lost done of the stage
    # before had been sent again, so that stage was run by its successor.
    "component fails ahead of its tick": Scenario(
        seed=20704,
        ticks=2,
        parts=(
            Part(
                "a0/player",
                "Player",
                ("think", "tidy"),
                {"ballast": 20, "bursts": 3, "crash_in": "again", "crash_tick": 2},
            ),
            Part("b1/conductor", "Conductor", ("think", "tidy"), {"ballast": 20, "bursts": 3, "early": True}),
        ),
        stages=("think", "tidy"),
        hosting="single",
        period_us=10_000,
        weather=Weather(loss=0.288, duplicate=0.0001, delay=0.2982, delay_us=18_409, hiccup=0.0107),
    ),
    # A paused run restarted a component twice at one boundary; a replay took the last messages of both incarnations for
    # those of the first.
    "restarted twice at one boundary": Scenario(
        seed=20007,
        ticks=3,
        parts=(Part("b0/player", "Player", ("think",), {"work_us": 20_000}), Part("b1/player", "Player", ("think",))),
        stages=("think", "tidy"),
        period_us=10_000,
        actions=(
            Action("steer", after_tick=1, delay_us=17, target="b0/player", word="restart"),
            Action("pause", after_tick=1, delay_us=347, target="b1/player", amount=360_543),
            Action("steer", after_tick=2, delay_us=1_095, target="b0/player", word="restart"),
        ),
    ),
}
