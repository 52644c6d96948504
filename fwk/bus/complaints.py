"""Datagrams that a process refused: named once for each kind, counted always."""

from fwk.component.log import Logger


class Complaints:
    """Datagrams refused: each kind is named once, all are counted."""

    def __init__(self, log: Logger) -> None:
        self.total = 0
        self._log = log
        self._counts: dict[tuple[str, str], int] = {}

    def __call__(self, channel: str, text: str) -> None:
        """Takes one; logs the first and then every power of ten of the same kind."""
        self.total += 1
        key = (channel, text.partition(";")[0].partition(":")[0][:60])
        if key not in self._counts and len(self._counts) >= 100:
            key = ("", "others")
        count = self._counts[key] = self._counts.get(key, 0) + 1
        if count == 1:
            self._log.warning(f"{channel}: {text}")
        elif str(count).strip("0") == "1":
            self._log.warning(f"{channel}: {text} ({count} times)")
