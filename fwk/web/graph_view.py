"""Element that shows the graph of a system."""

from collections.abc import Callable
from typing import Any

from nicegui.element import Element


class GraphView(Element, component="graph.js"):
    """The drawing at an address, which is asked for again and again; no name in it becomes markup of the page.

    Args:
        url: where the drawing comes from.
        label: what a screen reader says.
        period_s: time from question to question.
    """

    def __init__(self, url: str, label: str, period_s: float) -> None:
        super().__init__()
        self._props.update({"url": url, "label": label, "period": round(period_s * 1000)})

    def show(self, url: str) -> None:
        """Shows the drawing at another address."""
        self._props["url"] = url
        self.update()

    def on_pick(self, take: Callable[[str], Any]) -> None:
        """Calls a function with the name of a component that was clicked."""
        self.on("pick", lambda event: take(event.args))
