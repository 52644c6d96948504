"""Arrangement of the views in Rerun."""

from typing import Any, NamedTuple

import rerun.blueprint as rrb

from fwk.log_tools.frames import WORLD

TICK, TIME = "tick", "time"
"""Time lines."""
VIEWS, PLOTS, IMAGES, LOG = "views", "plots", "images", "log"
"""First parts of the paths of entities that are not channels."""
_TABS_MAX = 12


class Contents(NamedTuple):
    """Contents of a recording that need a place on the screen, in the order of their first appearance."""

    views: tuple[str, ...]
    """Titles of the views of projects."""
    positions: tuple[str, ...]
    """Channels with positions."""
    scans: tuple[str, ...]
    """Channels with scans."""
    cameras: tuple[str, ...]
    plots: tuple[str, ...]
    """Channels with numbers."""
    span_m: float
    """Distance from the origin of what is to be seen at first."""


def layout_of(contents: Contents) -> rrb.Blueprint:
    """Returns drawings and positions above, with images at their side; plots and log lines below.

    Everything else is in the list of entities, from which people add what they want to see.
    """
    space = rrb.SpatialInformation(target_frame=WORLD)
    eye = rrb.EyeControls3D(
        position=(0.0, -0.7 * contents.span_m, 1.4 * contents.span_m),
        look_target=(0.0, 0.0, 0.0),
        eye_up=(0.0, 1.0, 0.0),
    )
    spaces: list[tuple[str, list[str]]] = [(view, [f"/{VIEWS}/{view}/**"]) for view in contents.views]
    if contents.positions:
        spaces.append(("positions", [f"/{channel}/**" for channel in (*contents.positions, *contents.scans)]))
    drawn: list[Any] = [
        rrb.Spatial3DView(name=name, origin="/", contents=paths, spatial_information=space, eye_controls=eye)
        for name, paths in spaces
    ]
    drawn += [rrb.Spatial3DView(name=channel, origin=f"/{channel}/scan") for channel in contents.scans[:_TABS_MAX]]
    images = [rrb.Spatial2DView(name=each, origin=f"/{IMAGES}/{each}") for each in contents.cameras[:_TABS_MAX]]
    plotted = dict.fromkeys((*contents.positions, *contents.plots))
    plots = [
        rrb.TimeSeriesView(name=channel, origin=f"/{PLOTS}/{channel}")
        for channel in [channel for channel in plotted if channel in contents.plots][:_TABS_MAX]
    ]
    log = rrb.TextLogView(name="log", origin=f"/{LOG}")
    above = [rrb.Tabs(*tabs) for tabs in (drawn, images) if tabs]
    below = [rrb.Tabs(*plots), log] if plots else [log]
    rows = [rrb.Horizontal(*above, column_shares=[2, 1][: len(above)])] if above else []
    parts = rrb.Vertical(*rows, rrb.Horizontal(*below), row_shares=[2, 1][-len(rows) - 1 :])
    return rrb.Blueprint(parts, rrb.TimePanel(state="collapsed", timeline=TICK), auto_layout=False, auto_views=False)
