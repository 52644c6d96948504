"""Counts the datagrams that a process refused, and names each kind once."""

from fwk.component.log import Logger


class Complaints:
    """Counter of refused datagrams that logs each kind."""

    def __init__(self, log: Logger) -> None:
        self.total = 0
        self._log = log
        self._counts: dict[tuple[str, str], int] = {}

    def __call__(self, channel: str, text: str) -> None:
        """Counts a refused datagram; logs the first of its kind, the tenth, the hundredth and so on."""
        self.total += 1
        key = (channel, text.partition(";")[0].partition(":")[0][:60])
        if key not in self._counts and len(self._counts) >= 100:
            key = ("", "others")
        count = self._counts[key] = self._counts.get(key, 0) + 1
        if count == 1:
            self._log.warning(f"{channel}: {text}")
        elif str(count).strip("0") == "1":
            self._log.warning(f"{channel}: {text} ({count} times)")
