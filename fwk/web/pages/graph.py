"""Page of the graph: stages from left to right, channels as curves with their rates, states as colours."""

from nicegui import ui

from fwk.web.graph_view import GraphView
from fwk.web.layout import Frame, body

_REFRESH_S = 2.0


def build(frame: Frame) -> None:
    """Makes the page."""

    def address() -> str:
        return frame.address("/graph.svg", around=names.value or "")

    with body():
        with ui.row().classes("items-center"):
            names = ui.input("components, such as cyan1/*", value=frame.request.query_params.get("around", ""))
            names.props("dense outlined clearable debounce=300").classes("w-72").props("data-name=around")
            ui.label("click a component: its channels with their rates").classes("opacity-70")
        graph = GraphView(address(), "graph of the components", _REFRESH_S)
    names.on_value_change(lambda: graph.show(address()))
    frame.on_tick(lambda: graph.show(address()))
    graph.on_pick(names.set_value)
