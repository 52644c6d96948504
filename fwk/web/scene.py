"""A drawing in metres that a view makes and the canvas of the browser shows."""

import json
import math
from collections.abc import Callable, Hashable, Mapping, Sequence
from fnmatch import filter as matching
from fnmatch import fnmatchcase
from functools import lru_cache
from typing import Any, NamedTuple, TypeVar
from zlib import crc32

Point = tuple[float, float]
_SIGMAS = 2.0
K = TypeVar("K", bound=Hashable)


class Drawing(NamedTuple):
    """A drawing as browsers get it, in JSON."""

    moving: bytes
    ground: bytes
    """Shapes that seldom change; a browser that has them does not get them again."""

    @property
    def name(self) -> str:
        """Name of this drawing; equal drawings have equal names."""
        return f"{crc32(self.moving):x}.{self.ground_name}"

    @property
    def ground_name(self) -> str:
        """Name of the ground."""
        return f"{crc32(self.ground):x}"

    def beyond(self, ground_name: str) -> bytes:
        """Returns the drawing for a browser that has the ground of this name."""
        if ground_name == self.ground_name:
            return self.moving
        return b'{"ground":{"name":"%s","shapes":%s},%s' % (self.ground_name.encode(), self.ground, self.moving[1:])


class Newest:
    """The newest messages, decoded; called with a channel it returns that message, or None before the first.

    Args:
        messages: by channel.
        settings: value by component and dotted name.
    """

    def __init__(self, messages: Mapping[str, Any], settings: Mapping[tuple[str, str], Any] | None = None) -> None:
        self._messages = messages
        self._settings = settings or {}

    def __call__(self, channel: str) -> Any:
        """Returns the newest message of a channel."""
        return self._messages.get(channel)

    def matching(self, pattern: str) -> dict[str, Any]:
        """Returns the messages of all channels that match a pattern, in the order of their names."""
        return {channel: self._messages[channel] for channel in sorted(matching(self._messages, pattern))}

    def settings(self, components: str, name: str) -> dict[str, Any]:
        """Returns the settings below `name` of the first component that has them; empty: no component has.

        Args:
            components: pattern of the names of the components.
            name: name of the group of settings, such as `mirror`.
        """
        found: dict[str, dict[str, Any]] = {}
        for (component, setting), value in self._settings.items():
            group, _, rest = setting.partition(".")
            if group == name and rest and fnmatchcase(component, components):
                found.setdefault(component, {})[rest] = value
        return found[min(found)] if found else {}


class Scene:
    """Collects shapes; x points to the right, y up, lengths are in metres, colours are those of CSS.

    Shapes belong to layers, which people can hide. A shape with `pick` can be chosen, one with `drag` be dragged, under
    that name; the canvas draws the last seconds of the positions of a circle with `trail`.
    """

    def __init__(self) -> None:
        self.bounds: tuple[float, float, float, float] | None = None
        """Smallest x and y, largest x and y that the canvas shows at first; None: all that is drawn."""
        self.background = ""
        """Colour behind everything; empty: that of the page."""
        self.headline = ""
        """Line of text above the drawing."""
        self._picture: dict[str, Any] | None = None
        self._layer = self._of = ""
        self._shapes: list[dict[str, Any]] = []
        self._ground: tuple[list[dict[str, Any]], bytes] = [], b"[]"

    def picture(self, camera: str, frame: int, width_px: int, height_px: int) -> None:
        """Draws over the newest image of a camera: lengths are then in pixels, and y points down."""
        self._picture = {"camera": camera, "frame": frame, "width": width_px, "height": height_px}
        self.bounds = (-0.5, -0.5, width_px - 0.5, height_px - 0.5)

    def ground(self, draw: "Callable[[Scene, K], None]", of: K) -> None:
        """Draws shapes below all others that depend on one hashable value; browsers get and paint them once.

        Args:
            draw: a function of a module, called once for each value.
            of: the value, such as the measures of a field.
        """
        self._ground = _ground(draw, of)

    def layer(self, name: str, of: str = "") -> None:
        """Names the layer of the shapes that follow.

        Args:
            name: the layer.
            of: what the shapes show, such as a robot: in browsers they glide to the shapes of the same layer and thing
                in the next drawing.
        """
        self._layer, self._of = name, of

    def circle(
        self,
        x_m: float,
        y_m: float,
        radius_m: float,
        fill: str = "",
        stroke: str = "",
        width_m: float = 0.02,
        pick: str = "",
        drag: str = "",
        trail: str = "",
    ) -> None:
        """Draws a circle."""
        where = {"x": x_m, "y": y_m, "r": radius_m}
        self._add("circle", where, fill=fill, stroke=stroke, width=width_m, pick=pick, drag=drag, trail=trail)

    def ellipse(self, x_m: float, y_m: float, covariance_m2: Sequence[Sequence[float]], stroke: str) -> None:
        """Draws two standard deviations of a covariance of x and y."""
        (xx, xy), (_, yy) = (row[:2] for row in covariance_m2[:2])
        if not all(map(math.isfinite, (xx, xy, yy))):
            return
        middle, spread = (xx + yy) / 2, math.hypot((xx - yy) / 2, xy)
        axes = [_SIGMAS * math.sqrt(max(0.0, middle + sign * spread)) for sign in (1, -1)]
        angle = math.atan2(2 * xy, xx - yy) / 2
        self._add("ellipse", {"x": x_m, "y": y_m, "a": axes[0], "b": axes[1], "t": angle}, stroke=stroke, width=0.02)

    def line(self, points: Sequence[Point], stroke: str, width_m: float = 0.03, dashed: bool = False) -> None:
        """Draws a line through points."""
        self._add("line", {"p": [list(point) for point in points]}, stroke=stroke, width=width_m, dashed=dashed)

    def polygon(self, points: Sequence[Point], fill: str = "", stroke: str = "", width_m: float = 0.02) -> None:
        """Draws a closed line through points, filled or not."""
        self._add("polygon", {"p": [list(point) for point in points]}, fill=fill, stroke=stroke, width=width_m)

    def text(self, x_m: float, y_m: float, text: str, fill: str, height_m: float = 0.2) -> None:
        """Writes a text, centred."""
        self._add("text", {"x": x_m, "y": y_m, "h": height_m, "s": text}, fill=fill)

    def encoded(self) -> bytes:
        """Returns all of the drawing in JSON; shapes at positions that are not numbers are left out."""
        return self._encoded([*self._ground[0], *self._finite()])

    def drawing(self) -> Drawing:
        """Returns the drawing for browsers, its ground apart."""
        return Drawing(self._encoded(self._finite()), self._ground[1])

    def _finite(self) -> list[dict[str, Any]]:
        return [shape for shape in self._shapes if _finite(shape)]

    def _encoded(self, shapes: list[dict[str, Any]]) -> bytes:
        about = {"bounds": self.bounds, "background": self.background, "headline": self.headline}
        return _json({"shapes": shapes, **about, "picture": self._picture})

    def _add(self, kind: str, where: dict[str, Any], **look: Any) -> None:
        look["of"] = self._of
        self._shapes.append({"k": kind, "l": self._layer, **_rounded(where), **{k: v for k, v in look.items() if v}})


@lru_cache(maxsize=16)
def _ground(draw: Callable[[Scene, Any], None], of: Hashable) -> tuple[list[dict[str, Any]], bytes]:
    """Returns the shapes that a function draws of a value, also as JSON."""
    scene = Scene()
    draw(scene, of)
    shapes = scene._finite()
    return shapes, _json(shapes)


def _json(value: Any) -> bytes:
    return json.dumps(value, separators=(",", ":"), allow_nan=False).encode()


def _rounded(where: dict[str, Any]) -> dict[str, Any]:
    """Returns positions to the millimetre: half the bytes."""
    return {name: _round(value) for name, value in where.items()}


def _round(value: Any) -> Any:
    if isinstance(value, list):
        return [_round(each) for each in value]
    return round(value, 3) if isinstance(value, float) else value


def _finite(value: Any) -> bool:
    if isinstance(value, dict):
        return all(map(_finite, value.values()))
    if isinstance(value, list):
        return all(map(_finite, value))
    return not isinstance(value, float) or math.isfinite(value)
