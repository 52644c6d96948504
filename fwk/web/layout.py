"""The frame of all pages: navigation, choice of the run, clock, and the banner of an ended run."""

from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlencode

from nicegui import ui
from starlette.requests import Request

from fwk.clock import US_PER_S, monotonic_us
from fwk.control.client import ControlError
from fwk.web.access import Role
from fwk.web.canvas import Canvas
from fwk.web.console import STATIC, Console
from fwk.web.recorded_link import RecordedLink
from fwk.web.run_link import RunLink
from fwk.web.transport import Transport
from fwk.web.view import RunAccess
from fwk.web.words import seconds

THEME = "fwk_theme"
"""Cookie with the theme that a person has chosen."""
PAGES = {
    "/": ("System", "account_tree"),
    "/view": ("View", "map"),
    "/board": ("Blackboard", "dashboard"),
    "/devices": ("Devices", "sensors"),
    "/graph": ("Graph", "hub"),
    "/plots": ("Plots", "show_chart"),
    "/settings": ("Settings", "tune"),
    "/log": ("Log", "subject"),
    "/recordings": ("Recordings", "history"),
    "/runs": ("Runs", "dns"),
}
"""Address of a page to its title and icon."""
OF_RUNS = ("/", "/runs")
"""Pages that show runs alone, and no recording."""
SPEEDS = {"": "speed", "0.1": "x 0.1", "0.5": "x 0.5", "1": "x 1", "2": "x 2", "5": "x 5", "0": "max"}
_REFRESH_S = 0.5
_LAG_FACTOR = 4
"""Pages of a run that needs all processors are refreshed so many times more rarely."""
_STATUS_S = 2.0
"""Age of the state of all components where a page needs it for its head alone."""
_OTHER_THEME = f"""() => {{
    const dark = !document.body.classList.contains('body--dark');
    setDark(dark);
    document.cookie = `{THEME}=${{dark ? 'dark' : 'light'}}; path=/; max-age=31536000; SameSite=Strict`;
}}"""


_OTHER_TICK = """{
    const other = (address) => { const made = new URL(address); made.searchParams.set('tick', %d); return made.href; };
    history.replaceState(history.state, '', other(location.href));
    for (const link of document.querySelectorAll('a.fwk-link[href*="log="]')) link.href = other(link.href);
}"""
_TELL_HIDDEN = """<script>{
    const tell = () => emitEvent("visibility", document.hidden);
    document.addEventListener("visibilitychange", tell);
    addEventListener("load", () => setTimeout(tell, 1000)); // a page that was opened behind others
}</script>"""


class Frame:
    """The frame of an open page."""

    def __init__(
        self, console: Console, request: Request, role: Role, link: RunLink | RecordedLink, runs: dict[str, Any]
    ) -> None:
        self.console = console
        self.request = request
        self.link = link
        self.access = RunAccess(self.link, role)
        self.role = role
        self.may_steer = self.access.may_steer
        self._runs = runs
        self._hidden = False
        self._lags = False
        self._on_status: list[Callable[[dict[str, Any]], None]] = []
        self._on_tick: list[Callable[[], Any]] = []
        self._transport: Transport | None = None

    @property
    def run(self) -> str:
        """Name of the chosen run or recording; empty if no run exists."""
        return self.link.name

    def address(self, path: str, **fields: str) -> str:
        """Returns the address of another page for the same run, or for the same tick of the same recording."""
        own = {} if self.link.recorded and path in OF_RUNS else self._chosen()
        query = {name: value for name, value in {**own, **fields}.items() if value}
        return f"{path}?{urlencode(query)}" if query else path

    def _chosen(self) -> dict[str, str]:
        """Returns the parameters of addresses that name the run, or the tick of the recording."""
        if isinstance(self.link, RecordedLink):
            return {"log": self.link.name, "tick": str(self.link.tick)}
        return {"run": self.run}

    def canvas(self, label: str, period_s: float, drags: bool = False, **what: str) -> Canvas:
        """Makes a canvas that shows a view or a device of the run, or of the recording at the chosen tick.

        Args:
            label: name for screen readers.
            period_s: least time from drawing to drawing.
            drags: whether shapes can be dragged.
            what: parameter `view` or `device` of the drawings.
        """

        def addresses() -> tuple[str, str]:
            return f"/drawing?{urlencode({**self._chosen(), **what})}", f"/image?{urlencode(self._chosen())}"

        url, images = addresses()
        made = Canvas(url, label, period_s, drags, images)
        self.on_tick(lambda: made.show(*addresses()))
        return made

    def on_tick(self, take: Callable[[], Any]) -> None:
        """Calls a function after another tick of a recording was chosen."""
        self._on_tick.append(take)

    def go(self, tick: int) -> None:
        """Chooses a tick of a recording."""
        if self._transport:
            self._transport.go(tick)

    @property
    def lags(self) -> bool:
        """Whether the run needs all processors."""
        return self._lags

    def on_status(self, take: Callable[[dict[str, Any]], None]) -> None:
        """Calls a function with each new state of the run."""
        self._on_status.append(take)

    def every(self, period_s: float, refresh: Callable[[], Awaitable[None]]) -> None:
        """Calls a function repeatedly while the page is visible, more rarely while the run needs all processors.

        The function waits while the run does not exist.
        """
        called_us = 0

        async def guarded() -> None:
            nonlocal called_us
            wait_us = period_s * US_PER_S * (_LAG_FACTOR - 0.5 if self._lags else 0)
            if self._hidden or monotonic_us() < called_us + wait_us:
                return
            called_us = monotonic_us()
            try:
                await refresh()
            except ControlError:
                return  # the banner of the frame says so

        ui.timer(period_s, guarded)

    async def do(self, action: Awaitable[Any], done: str = "") -> Any:
        """Carries an action out and shows its result or the reason of its refusal; returns None after a refusal."""
        try:
            result = await action
        except ControlError as error:
            ui.notify(str(error), type="negative", multi_line=True, close_button="close", timeout=10_000)
            return None
        if done:
            ui.notify(done, type="positive")
        return result

    def build(self, path: str, extra: dict[str, tuple[str, str]]) -> None:
        """Makes header and navigation."""
        theme = {"dark": True, "light": False}.get(self.request.cookies.get(THEME, ""))
        ui.dark_mode(theme)
        ui.add_css(STATIC / "console.css")
        ui.page_title(f"{PAGES.get(path, extra.get(path, ('fwk', '')))[0]} - {self.run or 'fwk'}")
        with ui.header().classes("fwk-header items-center no-wrap"):
            menu = ui.button(icon="menu").props('flat dense color=white aria-label="navigation"').classes("lt-md")
            ui.label("fwk").classes("fwk-brand gt-xs")
            names = sorted({*self._runs, *filter(None, [self.run])})
            choice = ui.select(names or [""], value=self.run, on_change=lambda each: self._choose(path, each.value))
            choice.props('dense dark borderless options-dense aria-label="run"').classes("fwk-run").props(
                "data-name=run"
            )
            self._state = ui.label("").classes("fwk-state").props("data-name=state")
            self._clock = ui.label("").classes("fwk-clock").props("data-name=clock")
            ui.space()
            self._build_steering()
            look = ui.button(icon="contrast").props('flat dense color=white aria-label="dark or light"')
            look.on("click", js_handler=_OTHER_THEME)
        with (
            ui.left_drawer(value=False)
            .props("width=180 breakpoint=900 bordered show-if-above")
            .classes("fwk-nav") as drawer
        ):
            for address, (title, icon) in {**PAGES, **extra}.items():
                with ui.link(target=self.address(address)).classes("fwk-link" + (" here" if address == path else "")):
                    ui.icon(icon)
                    ui.label(title)
            if self.role is Role.READ:
                ui.label("read only").classes("fwk-reader").props("data-name=read-only")
        menu.on_click(drawer.toggle)
        self._banner = ui.label("").classes("fwk-banner").props("data-name=banner")
        self._banner.set_visibility(False)
        self.every(_REFRESH_S, self._refresh)
        ui.add_body_html(_TELL_HIDDEN)
        ui.add_body_html(f"<script type='module'>{(STATIC / 'rows.js').read_text()}</script>")
        if isinstance(self.link, RecordedLink):
            with ui.element("div").classes("fwk-transport w-full"):
                self._transport = Transport(self.link.tick, self.link.last_tick, self._show_tick)
        ui.on("visibility", lambda event: self._show_or_hide(bool(event.args)))

    def _build_steering(self) -> None:
        if not self.may_steer or not self.run:
            return
        access = self.access
        look = "flat dense color=white"
        with ui.row().classes("items-center no-wrap gap-0"):
            self._pause = ui.button(icon="pause", on_click=self._pause_or_resume)
            self._pause.props(f'{look} aria-label="pause or resume"').props("data-name=pause").tooltip(
                "pause or resume"
            )
            step = ui.button(icon="skip_next", on_click=lambda: self.do(access.clock("step", ticks=1)))
            step.props(f'{look} aria-label="one tick"').props("data-name=step").tooltip("one tick, then pause")
            speed = ui.select(SPEEDS, value="", on_change=lambda each: self._speed(each.value))
            speed.props('dense dark borderless options-dense aria-label="speed"').classes("gt-xs").props(
                "data-name=speed"
            )

    async def _pause_or_resume(self) -> None:
        clock = await self.do(self.link.ask("speed"))
        if clock:
            await self.do(self.access.clock("resume" if clock["paused"] else "pause"))

    async def _speed(self, value: str) -> None:
        if value:
            await self.do(self.access.clock("speed", speed=float(value)))

    def _choose(self, path: str, run: str) -> None:
        if run and run != self.run:
            ui.navigate.to(f"{path}?{urlencode({'run': run})}")

    def _show_tick(self, tick: int) -> None:
        if isinstance(self.link, RecordedLink):
            self.link.tick = tick
        for take in self._on_tick:
            take()
        ui.run_javascript(_OTHER_TICK % tick)

    def _show_or_hide(self, hidden: bool) -> None:
        self._hidden = hidden

    async def _refresh(self) -> None:
        if not self.run:
            if await self.console.runs.all():
                ui.navigate.reload()
            return
        try:
            if isinstance(self.link, RecordedLink):
                self._state.set_text("recording")
                self._clock.set_text(seconds((await self.link.clock())["time_us"]))
                return
            about = await (self.link.status() if self._on_status else self.link.status(_STATUS_S))
            status = {**about, **await self.link.clock()}
            self._lags = await self.link.lags()
        except ControlError as error:
            self._say(f"{error}; this page goes on when it is started again")
            self._state.set_text("ended")
            return
        self._say("")
        self._state.set_text(state_of(status))
        self._clock.set_text(f"tick {status['tick']}  {seconds(status['time_us'])}  x {status['speed']:.2f}")
        if self.may_steer:
            self._pause.props(f"icon={'play_arrow' if status['paused'] else 'pause'}")
        for take in self._on_status:
            take(status)

    def _say(self, text: str) -> None:
        if self._banner.text != text:
            self._banner.set_text(text)
            self._banner.set_visibility(bool(text))


def state_of(status: dict[str, Any]) -> str:
    """Returns the state of a run in a few words."""
    if status["paused"]:
        return "paused"
    if status["waits_for"]:
        return f"waits for {status['waits_for'][0]}"
    failed = sum(each["state"] == "failed" for each in status["components"])
    return f"running, {failed} failed" if failed else "running"


@contextmanager
def body() -> Iterator[None]:
    """Makes the area for the contents of a page."""
    with ui.column().classes("fwk-body w-full"):
        yield
