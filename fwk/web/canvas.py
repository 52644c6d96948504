"""Element that shows the drawings of a view."""

from collections.abc import Callable, Sequence
from typing import Any

from nicegui.element import Element


class Canvas(Element, component="canvas.js"):
    """A canvas that asks an address for drawings; people zoom, shift, choose and drag on it.

    Args:
        url: where the drawings come from.
        label: what a screen reader says.
        period_s: least time from drawing to drawing.
        drags: whether shapes can be dragged.
        images: where the images of cameras come from; the canvas adds camera and frame.
    """

    def __init__(self, url: str, label: str, period_s: float, drags: bool = False, images: str = "") -> None:
        super().__init__()
        self._props.update({"url": url, "label": label, "period": round(period_s * 1000)})
        self._props.update({"drags": drags, "hidden": [], "images": images})

    def hide(self, layers: Sequence[str]) -> None:
        """Hides layers; shows all others."""
        self._props["hidden"] = list(layers)
        self.update()

    def show(self, url: str, images: str = "") -> None:
        """Asks other addresses for drawings and images."""
        self._props.update({"url": url, "images": images})
        self.update()

    def on_pick(self, take: Callable[[str], Any]) -> None:
        """Calls a function with the name of a chosen shape; empty: none."""
        self.on("pick", lambda event: take(event.args))

    def on_moved(self, take: Callable[[str, float, float], Any]) -> None:
        """Calls a function with the name of a dragged shape and its new position."""
        self.on("moved", lambda event: take(event.args["name"], float(event.args["x"]), float(event.args["y"])))

    def on_layers(self, take: Callable[[list[str]], Any]) -> None:
        """Calls a function with the names of the layers when they change."""
        self.on("layers", lambda event: take(event.args))

    def on_headline(self, take: Callable[[str], Any]) -> None:
        """Calls a function with the headline when it changes."""
        self.on("headline", lambda event: take(event.args))
