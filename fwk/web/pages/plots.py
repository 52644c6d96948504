"""Page of the plots: curves of any numeric fields together."""

import asyncio

from nicegui import ui

from fwk.clock import US_PER_S
from fwk.lcm.event_log import LogError
from fwk.log_tools.series import series_in
from fwk.web.layout import Frame, body
from fwk.web.plotting import Curves, FieldNameError, number_at, parted, recorded_series
from fwk.web.recorded_link import RecordedLink

_ASK_S = 0.1
_INK = "#7b8794"  # readable on light and on dark pages
_DRAW_S = 0.5


def build(frame: Frame) -> None:
    """Makes the page."""
    curves = Curves()
    fields: list[str] = []
    shown: list[str] = []
    with body():
        asked = frame.request.query_params.get("fields", "")
        chosen = ui.input("fields, such as cyan1/pose.x_m, cyan1/pose.y_m", value=asked)
        chosen.props("dense outlined clearable debounce=500").classes("w-full")
        mistake = ui.label("").classes("text-negative").props("data-name=mistake")
        chart = ui.echart(
            {
                "animation": False,
                "legend": {"top": 0, "textStyle": {"color": _INK}},
                "tooltip": {"trigger": "axis"},
                "grid": {"left": 60, "right": 20, "top": 40, "bottom": 40},
                "xAxis": {"type": "value", "scale": True, "name": "s", "axisLabel": {"color": _INK}},
                "yAxis": {"type": "value", "scale": True, "axisLabel": {"color": _INK}},
                "series": [],
            }
        )
        chart.classes("w-full").style("height: calc(100vh - 190px); min-height: 240px").props(
            'role=img aria-label="curves"'
        )

    def choose() -> None:
        fields[:] = [each.strip() for each in (chosen.value or "").split(",") if each.strip()]
        try:
            for each in fields:
                parted(each)
        except FieldNameError as error:
            mistake.set_text(str(error))
            fields.clear()
            return
        mistake.set_text("")
        curves.choose(fields)
        chart.options["series"] = []

    async def show_recorded(link: RecordedLink) -> None:
        """Shows the curves of the whole recording with the chosen tick."""
        nonlocal shown
        if shown != fields:
            shown = [*fields]
            try:
                series, _ = await asyncio.to_thread(series_in, link.run.path, shown) if shown else ([], [])
            except LogError as error:
                mistake.set_text(str(error))
                return
            chart.options["series"] = recorded_series(series)
        mark_s = (await link.clock())["time_us"] / US_PER_S
        for each in chart.options["series"][:1]:
            each["markLine"] = {"symbol": "none", "animation": False, "data": [{"xAxis": mark_s}]}
        chart.update()

    async def ask() -> None:
        if isinstance(frame.link, RecordedLink):
            await show_recorded(frame.link)
            return
        if not fields:
            return
        wanted = {each: parted(each) for each in fields}
        newest = await frame.link.newest(sorted({channel for channel, _ in wanted.values()}))
        time_us = (await frame.link.clock())["time_us"]
        for each, (channel, field) in wanted.items():
            message = newest.get(channel)
            header = getattr(message, "header", None)
            curves.add(each, header.time_us if header else time_us, number_at(message, field))

    async def draw() -> None:
        if fields and not frame.link.recorded:
            chart.options["series"] = curves.series()
            chart.update()

    chosen.on_value_change(choose)
    choose()
    frame.every(_DRAW_S if frame.link.recorded else _ASK_S, ask)
    frame.every(_DRAW_S, draw)
