"""Rates of channels."""

from typing import Any

from fwk.clock import US_PER_S


class Rates:
    """Rates of channels from the numbers of messages in two answers."""

    def __init__(self) -> None:
        self._before: dict[str, int] = {}
        self._before_us = 0
        self._rates: dict[str, float] = {}

    def measure(self, rows: list[dict[str, Any]], now_us: int) -> dict[str, float]:
        """Returns messages a second by channel, since the last answer; empty for the first."""
        elapsed_us = now_us - self._before_us
        if self._before and elapsed_us < US_PER_S // 2:
            return self._rates
        if self._before:
            self._rates = {
                row["channel"]: max(0, row["messages"] - self._before.get(row["channel"], 0)) * US_PER_S / elapsed_us
                for row in rows
            }
        self._before = {row["channel"]: row["messages"] for row in rows}
        self._before_us = now_us
        return self._rates
