"""The goals that the benchmark can judge, each with its deciding figure."""

from collections.abc import Sequence
from dataclasses import dataclass

from tools.bench.figures import Runs, Spread, error_us, tick_mean_us, tick_us
from tools.bench.own import AT_100_HZ, SOAK, SOCCER
from tools.bench.registry import Peer

OWN = "fwk"
BARE = "lcm"
_CONTRACT_LIMIT = 1.25
_FLAT_LIMIT = 1.30
_RECORDER_LIMIT = 1.15
_LOSS_LIMIT = 1.20
_FIRST_TICK_S = 3.0
_PSS_MB = 1200.0
_JITTER_US = 1000.0
_SOAK_S = 600.0
_SOAK_PERIODS = 0.99 * 100 * _SOAK_S  # ticks at the beginning that are not counted


@dataclass(frozen=True)
class Verdict:
    """One goal: whether it is met (None: not measured), and the figures."""

    goal: str
    met: bool | None
    figures: str

    @property
    def word(self) -> str:
        """Returns the verdict as a word for tables."""
        return {True: "met", False: "missed", None: "not measured"}[self.met]


def judge(runs: Runs, peers: Sequence[Peer], sizes: Sequence[int]) -> list[Verdict]:
    """Judges all goals that these runs cover."""
    return [
        _at_most(
            f"full contract at most {_CONTRACT_LIMIT} x bare LCM at every N", _CONTRACT_LIMIT, _contract(runs, sizes)
        ),
        _ahead(runs, peers, sizes),
        _flat(runs, sizes),
        _at_most(
            "recorder and gateway together at most +15 %",
            _RECORDER_LIMIT,
            {f"N={size}": runs.ratio("fwk_recorded", OWN, f"N={size}") for size in sizes},
        ),
        _at_most(
            "recovery from 1 % loss at most +20 % (mean tick)",
            _LOSS_LIMIT,
            {f"N={size}": _loss(runs, size) for size in sizes},
        ),
        _start(runs),
        _jitter(runs),
        _missed(runs),
    ]


def _contract(runs: Runs, sizes: Sequence[int]) -> dict[str, Spread | None]:
    return {f"N={size}": runs.ratio(OWN, BARE, f"N={size}") for size in sizes}


def _at_most(goal: str, limit: float, ratios: dict[str, Spread | None]) -> Verdict:
    known = {name: ratio for name, ratio in ratios.items() if ratio is not None}
    if not known:
        return Verdict(goal, None, "")
    figures = ", ".join(
        f"{name} x{ratio.middle:.2f} ({ratio.low:.2f}-{ratio.high:.2f})" for name, ratio in known.items()
    )
    return Verdict(goal, all(ratio.middle <= limit for ratio in known.values()), figures)


def _ahead(runs: Runs, peers: Sequence[Peer], sizes: Sequence[int]) -> Verdict:
    """Judges the lead over each peer measured on both sides; bare transports are parts of fwk, not rivals."""
    goal = "ahead of every peer that moves the same typed data"
    behind, closest = [], []
    for peer in peers:
        if peer.bare or peer.name.startswith(OWN):
            continue
        ratios = {size: runs.ratio(peer.name, OWN, f"N={size}") for size in sizes}
        known = {size: ratio.middle for size, ratio in ratios.items() if ratio is not None}
        behind += [f"{peer.title} N={size} x{ratio:.2f}" for size, ratio in known.items() if ratio <= 1]
        if known:
            size = min(known, key=lambda number: known[number])
            closest.append(f"{peer.title} x{known[size]:.2f} (N={size})")
    if not closest:
        return Verdict(goal, None, "")
    return Verdict(goal, not behind, f"behind: {', '.join(behind)}" if behind else "least lead: " + ", ".join(closest))


def _flat(runs: Runs, sizes: Sequence[int]) -> Verdict:
    """Judges wall time per component: the largest N against N=20, within each round."""
    goal = "cost per component flat from N=20 to N=160 within 30 %"
    if 20 not in sizes or 160 not in sizes:
        return Verdict(goal, None, "")
    ratio = runs.ratio(OWN, OWN, "N=160", "N=20")
    if ratio is None:
        return Verdict(goal, None, "")
    each = {size: runs.spread(OWN, f"N={size}", tick_us) for size in sizes}
    figures = ", ".join(f"N={size} {spread.middle / size:.0f} us" for size, spread in each.items() if spread)
    return Verdict(goal, ratio.middle / 8 <= _FLAT_LIMIT, f"{figures}; N=160 to N=20 x{ratio.middle / 8:.2f}")


def _start(runs: Runs) -> Verdict:
    goal = f"{SOCCER}: first tick within {_FIRST_TICK_S:g} s, at most {_PSS_MB:g} MB together"
    first = runs.spread(OWN, SOCCER, lambda result: float(result["first_tick_s"]))
    held = runs.spread(OWN, SOCCER, lambda result: float(result["pss_mb"]))
    if first is None or held is None:
        return Verdict(goal, None, "")
    figures = f"{first.middle:.2f} s ({first.low:.2f}-{first.high:.2f}), {held.middle:.0f} MB"
    return Verdict(goal, first.middle <= _FIRST_TICK_S and held.middle <= _PSS_MB, figures)


def _jitter(runs: Runs) -> Verdict:
    goal = f"100 Hz with 20 components: p99 of the period's error at most {_JITTER_US / 1000:g} ms"
    spread = runs.spread(OWN, AT_100_HZ, lambda result: error_us(result, 0.99))
    if spread is None:
        return Verdict(goal, None, "")
    figures = f"{spread.middle / 1000:.2f} ms ({spread.low / 1000:.2f}-{spread.high / 1000:.2f})"
    return Verdict(goal, spread.middle <= _JITTER_US, figures)


def _missed(runs: Runs) -> Verdict:
    """Judges the longest run alone: rare events do not show in a short one."""
    goal = f"100 Hz with 20 components: no tick missed in {_SOAK_S / 60:g} minutes"
    ran = runs.of(OWN, SOAK)
    if not ran:
        return Verdict(goal, None, "")
    missed, periods = sum(int(run.result["missed"]) for run in ran), sum(len(run.result["error_us"]) for run in ran)
    long_enough = periods >= _SOAK_PERIODS
    return Verdict(goal, missed == 0 if long_enough or missed else None, f"{missed} of {periods} periods")


def _loss(runs: Runs, size: int) -> Spread | None:
    """Returns the ratio of mean ticks with and without loss, from the medians of the rounds' means."""
    with_loss = runs.spread(OWN, f"N={size}, loss 1 %", tick_mean_us)
    without = runs.spread(OWN, f"N={size}", tick_mean_us)
    if with_loss is None or without is None:
        return None
    return Spread(
        with_loss.middle / without.middle,
        with_loss.low / without.middle,
        with_loss.high / without.middle,
        with_loss.rounds,
    )
