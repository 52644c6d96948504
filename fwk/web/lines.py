"""Element for many lines of text that grow at the end."""

from collections.abc import Sequence

from nicegui.element import Element


class Lines(Element, component="lines.js"):
    """Lines of text, each with a number, a class for its colour and a tick; only the newest are kept."""

    def __init__(self, most: int = 2000) -> None:
        super().__init__()
        self._props["most"] = most

    def link_ticks(self, address: str) -> None:
        """Lets each line lead to an address that its tick completes."""
        self._props["link"] = address
        self.update()

    def append(self, lines: Sequence[tuple[int, str, str, int]]) -> None:
        """Adds lines: number, class, text, tick."""
        if lines:
            self.run_method("append", lines)

    def clear_lines(self) -> None:
        """Removes all lines."""
        self.run_method("clear")

    def follow(self, on: bool) -> None:
        """Keeps the last line in sight, or no longer."""
        self.run_method("follow", on)
