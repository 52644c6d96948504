"""Page of the views: drawings that projects make of a run, and the images of cameras."""

from nicegui import ui

from fwk.web.drawings import views_of
from fwk.web.layout import Frame, body
from fwk.web.pages.devices import show_device
from fwk.web.view import View

CAMERA_TYPE = "core.frame_t"
_LAYERS_MAX = 12


def build(frame: Frame) -> None:
    """Makes the page."""
    with body():
        area = ui.column().classes("w-full gap-1")

    async def fill() -> None:
        if area.default_slot.children:
            return
        views = await views_of(frame.console, frame.link)
        asked = frame.request.query_params.get("view", "0")
        number = int(asked) if asked.isdecimal() and int(asked) < len(views) else 0
        with area:
            await _show(frame, views, number)

    frame.every(1.0, fill)


async def _show(frame: Frame, views: list[View], number: int) -> None:
    view, link, access = views[number], frame.link, frame.access
    with ui.row().classes("items-center w-full gap-2"):
        titles = dict(enumerate(each.title for each in views))
        choice = ui.select(titles, value=number, on_change=lambda event: _other(frame, event.value))
        choice.props('dense outlined options-dense aria-label="view"').props("data-name=view")
        headline = ui.label("").classes("text-subtitle1").props("data-name=headline")
        ui.space()
        layers = ui.row().classes("items-center gap-0")
    drags = frame.may_steer and type(view).moved is not View.moved
    with ui.row().classes("w-full items-start"):
        canvas = frame.canvas(f"{view.title} of {frame.run}", 1 / view.rate_hz, drags, view=str(number))
        canvas.props("data-name=canvas").classes("fwk-view")
        chosen = ui.row().classes("fwk-chosen items-start")
    hidden: set[str] = set()

    def show_layers(names: list[str]) -> None:
        layers.clear()
        with layers:
            for name in names[:_LAYERS_MAX]:
                box = ui.checkbox(name, value=name not in hidden).props("dense").classes("q-mr-sm")
                box.on_value_change(lambda event, name=name: hide(name, not event.value))

    def hide(name: str, wanted: bool) -> None:
        (hidden.add if wanted else hidden.discard)(name)
        canvas.hide(sorted(hidden))

    async def pick(name: str) -> None:
        chosen.clear()
        cameras = [row["channel"] for row in await link.channels() if row["type"] == CAMERA_TYPE] if name else []
        with chosen:
            for channel in cameras:
                if channel.partition("/")[0] == name.partition("/")[0]:
                    with ui.column().classes("fwk-camera gap-0"):
                        await show_device(frame, channel)

    canvas.on_layers(show_layers)
    canvas.on_headline(headline.set_text)
    canvas.on_pick(pick)
    canvas.on_moved(lambda name, x_m, y_m: frame.do(view.moved(access, name, x_m, y_m)))


def _other(frame: Frame, number: int) -> None:
    ui.navigate.to(frame.address("/view", view=str(number)))
