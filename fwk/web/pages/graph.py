"""Page of the graph: stages from left to right, channels as curves, states as colours."""

from nicegui import ui

from fwk.web.layout import Frame, body

_REFRESH_S = 2.0


def build(frame: Frame) -> None:
    """Makes the page. The drawing is an image, so that no name in it can become markup of the page."""
    with body():
        names = ui.input("components, such as cyan1/*", value=frame.request.query_params.get("around", ""))
        names.props("dense outlined clearable debounce=300").classes("w-72")
        with ui.element("div").classes("fwk-graph"):
            image = ui.element("img").props('alt="graph of the components"')
    pictures = 0

    async def refresh() -> None:
        nonlocal pictures
        pictures += 1
        image.props["src"] = frame.address("/graph.svg", around=names.value or "", n=str(pictures))

    frame.every(_REFRESH_S, refresh)
