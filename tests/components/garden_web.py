"""A view and a page of a project's own for the console."""

from fwk.web import Newest, OpenPage, Page, RunAccess, Scene, View


class GardenView(View):
    """The mower, which can be dragged."""

    title = "Garden"
    needs = ("a/place",)
    channels = ("a/place",)

    def draw(self, newest: Newest, scene: Scene) -> None:
        scene.bounds = (-5.0, -5.0, 5.0, 5.0)
        scene.background = "#204020"
        place = newest("a/place")
        if place is not None:
            scene.headline = f"mower {place.label}"
            scene.layer("mower")
            scene.circle(place.x_m, place.y_m, 1.0, fill="#ff0000", pick="a/mower", drag="mower", trail="mower")
            scene.layer("belief")
            scene.ellipse(place.x_m, place.y_m, place.covariance_m2, "#ffffff")

    async def moved(self, run: RunAccess, name: str, x_m: float, y_m: float) -> None:
        await run.call("a/visit", {"x_m": x_m, "y_m": y_m, "note": f"dragged {name}"})


class GatePage(Page):
    """One button."""

    title = "Gate"
    path = "gate"
    needs = ("a/visit@outside",)

    def build(self, page: OpenPage) -> None:
        from nicegui import ui

        async def home() -> None:
            await page.do(page.access.call("a/visit", {"note": "home"}), "called home")

        ui.button("home", on_click=home).props("data-name=home")


class ElsewherePage(Page):
    """Never offered: no run has the channel."""

    title = "Elsewhere"
    path = "elsewhere"
    needs = ("nowhere/channel",)

    def build(self, page: OpenPage) -> None:
        raise AssertionError
