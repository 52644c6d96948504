"""The channels of a run with their rates."""

from typing import Any

from fwk.clock import US_PER_S, monotonic_us, sleep_s
from fwk.control import runs

_RATE_S = 1.0


def channels_with_rates(chosen: str | None) -> list[dict[str, Any]]:
    """Returns a row for each channel of a run; its `rate_hz` is measured for a second of wall time.

    Raises:
        ControlError: no run, or no answer.
    """
    with runs.gateway(chosen) as run:
        before, began_us = run.ask("channels")["channels"], monotonic_us()
        sleep_s(_RATE_S)
        rows, elapsed_us = run.ask("channels")["channels"], monotonic_us() - began_us
    earlier = {row["channel"]: row["messages"] for row in before}
    for row in rows:
        new = row["messages"] - earlier.get(row["channel"], 0)
        row["rate_hz"] = max(0, new) * US_PER_S / elapsed_us
    return list(rows)
