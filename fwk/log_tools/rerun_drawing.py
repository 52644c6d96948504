"""Drawings that views of a project make, as shapes of Rerun."""

import math
from collections.abc import Mapping
from typing import Any

import rerun as rr

_ROUND_STEPS = 32
_LIFT_M = 0.002
"""Height of each shape above the one before, so that later shapes cover earlier ones."""
PARTS = ("areas", "lines", "labels")
"""Entities of a layer."""
_GREY = (128, 128, 128, 255)

Point = tuple[float, float]
Colour = tuple[int, int, int, int]


def shapes_3d(drawing: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Returns the archetypes of each layer of a drawing on the ground, by name.

    Args:
        drawing: a drawing as the browser gets it (`Scene.encoded`), in metres.
    """
    layers: dict[str, _Layer] = {}
    for number, shape in enumerate(drawing["shapes"]):
        layers.setdefault(shape["l"] or "shapes", _Layer()).add(shape, number * _LIFT_M)
    return {name: layer.archetypes() for name, layer in layers.items()}


def shapes_2d(drawing: Mapping[str, Any]) -> dict[str, Any]:
    """Returns the archetypes of a drawing over an image, by name; lengths are in pixels."""
    layer = _Layer()
    for shape in drawing["shapes"]:
        layer.add(shape, 0.0)
    strips = [[point[:2] for point in strip] for strip in layer.strips]
    labels = [place[:2] for place in layer.places]
    return {
        "lines": rr.LineStrips2D(strips, colors=layer.colours, radii=layer.radii),
        "labels": rr.Points2D(labels, labels=layer.texts, colors=layer.text_colours, radii=0.0),
    }


class _Layer:
    """Shapes of one layer: lines, areas and texts."""

    def __init__(self) -> None:
        self.strips: list[list[tuple[float, float, float]]] = []
        self.colours: list[Colour] = []
        self.radii: list[float] = []
        self.places: list[tuple[float, float, float]] = []
        self.texts: list[str] = []
        self.text_colours: list[Colour] = []
        self._corners: list[tuple[float, float, float]] = []
        self._corner_colours: list[Colour] = []
        self._triangles: list[tuple[int, int, int]] = []

    def add(self, shape: Mapping[str, Any], z_m: float) -> None:
        """Adds a shape."""
        if shape["k"] == "text":
            self.places.append((shape["x"], shape["y"], z_m))
            self.texts.append(shape["s"])
            self.text_colours.append(_colour(shape.get("fill")))
            return
        points = _outline(shape)
        if fill := shape.get("fill"):
            self._fill(points, _colour(fill), z_m)
        stroke = shape.get("stroke")
        if stroke or not fill:
            is_open = shape["k"] == "line"
            self.strips.append([(x, y, z_m) for x, y in (points if is_open else [*points, points[0]])])
            self.colours.append(_colour(stroke))
            self.radii.append(shape.get("width", 0.02) / 2)

    def archetypes(self) -> dict[str, Any]:
        """Returns the archetypes in three dimensions, by name."""
        made: dict[str, Any] = {part: rr.Clear(recursive=False) for part in PARTS}
        if self.strips:
            made["lines"] = rr.LineStrips3D(self.strips, colors=self.colours, radii=self.radii)
        if self.places:
            made["labels"] = rr.Points3D(self.places, labels=self.texts, colors=self.text_colours, radii=0.0)
        if self._corners:
            made["areas"] = rr.Mesh3D(
                vertex_positions=self._corners,
                triangle_indices=self._triangles,
                vertex_colors=self._corner_colours,
                vertex_normals=[(0.0, 0.0, 1.0)] * len(self._corners),
            )
        return made

    def _fill(self, points: list[Point], colour: Colour, z_m: float) -> None:
        """Adds a convex area as a fan of triangles."""
        first = len(self._corners)
        self._corners += [(x, y, z_m) for x, y in points]
        self._corner_colours += [colour] * len(points)
        self._triangles += [(first, first + step, first + step + 1) for step in range(1, len(points) - 1)]


def _outline(shape: Mapping[str, Any]) -> list[Point]:
    if shape["k"] == "circle":
        return _ellipse(shape["x"], shape["y"], shape["r"], shape["r"], 0.0)
    if shape["k"] == "ellipse":
        return _ellipse(shape["x"], shape["y"], shape["a"], shape["b"], shape["t"])
    return [(x, y) for x, y in shape["p"]]


def _ellipse(x: float, y: float, a: float, b: float, turn_rad: float) -> list[Point]:
    return ellipse_outline((x, y), (a, b), turn_rad)


def ellipse_outline(centre: Point, axes: Point, turn_rad: float) -> list[Point]:
    """Returns points on an ellipse with these half axes."""
    cosine, sine = math.cos(turn_rad), math.sin(turn_rad)
    made = []
    for step in range(_ROUND_STEPS):
        angle_rad = 2 * math.pi * step / _ROUND_STEPS
        along, across = axes[0] * math.cos(angle_rad), axes[1] * math.sin(angle_rad)
        made.append((centre[0] + along * cosine - across * sine, centre[1] + along * sine + across * cosine))
    return made


def _colour(text: str | None) -> Colour:
    """Returns a colour that is written as in CSS: `#rgb`, `#rrggbb` or `#rrggbbaa`; grey for any other."""
    digits = (text or "").removeprefix("#")
    if len(digits) == 3:
        digits = "".join(2 * digit for digit in digits)
    try:
        values = list(bytes.fromhex(digits))
    except ValueError:
        return _GREY
    return (*values[:3], values[3] if len(values) == 4 else 255) if len(values) in (3, 4) else _GREY  # type: ignore[return-value]
