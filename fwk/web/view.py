"""Views on a canvas and pages that projects add to the console, and their access to a run."""

import asyncio
from abc import ABC, abstractmethod
from collections.abc import Awaitable, Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from fwk.bus.public import PublicBus
from fwk.component.services import RequestState
from fwk.control import runs
from fwk.control.client import RefusedError
from fwk.control.host_file import KeepError, Kept, keep
from fwk.control.requests import Action
from fwk.lcm import messages
from fwk.model.service_channels import OUTSIDE, service_channel
from fwk.plan.files.launch_file import host_file, shown
from fwk.web.access import Role
from fwk.web.file_settings import check_kept
from fwk.web.recorded_link import RecordedLink
from fwk.web.run_link import RunLink
from fwk.web.scene import Newest, Scene

_CALL_S = 10.0
_STEER_S = 60.0
_WELL = (RequestState.SENT, RequestState.ACCEPTED, RequestState.DONE)


class View(ABC):
    """A drawing of a run on a canvas, whose shapes move smoothly. A subclass sets `channels` and defines `draw`.

    The console offers a view for every run that has a channel for each pattern of `needs`.
    """

    title = "View"
    needs: Sequence[str] = ()
    """Patterns of channels without which there is nothing to draw."""
    channels: Sequence[str] = ()
    """Patterns of the channels whose newest messages `draw` gets."""
    members: Sequence[str] = ()
    """Only channels whose type has these members."""
    sees: Sequence[str] = ()
    """Channels beside a camera, without their namespace, whose newest messages `sight` gets."""
    sight_settings: Sequence[str] = ()
    """Groups of settings of components beside a camera that `sight` gets, such as its calibration."""
    settings: Sequence[str] = ()
    """Patterns `COMPONENT.GROUP` of the settings that `draw` gets."""
    rate_hz = 20.0
    """Highest rate of the drawings in a browser."""

    @abstractmethod
    def draw(self, newest: Newest, scene: Scene) -> None:
        """Draws the newest messages."""

    def sight(self, camera: str, newest: Newest, scene: Scene) -> None:  # noqa: B027  (optional)
        """Draws the detections in an image of a camera over that image; lengths are in pixels, y points down."""

    async def moved(self, run: "RunAccess", name: str, x_m: float, y_m: float) -> None:  # noqa: B027  (optional)
        """Takes the new position of a shape that was drawn with `drag=name` and that a person has dragged."""


class Page(ABC):
    """A page of a project's own. A subclass sets `needs` and defines `build`, which makes the page with NiceGUI."""

    title = "Page"
    path = "page"
    """Last part of its address."""
    icon = "extension"
    needs: Sequence[str] = ()
    """Patterns of channels that a run must have for this page to be offered."""

    @abstractmethod
    def build(self, page: "OpenPage") -> None:
        """Makes the elements of the page."""


class OpenPage(Protocol):
    """A page that a browser has open, for one run."""

    access: "RunAccess"
    may_steer: bool

    def every(self, period_s: float, refresh: Callable[[], Awaitable[None]]) -> None:
        """Calls a function repeatedly while the page is open; it waits while the run does not exist."""

    async def do(self, action: Awaitable[Any], done: str = "") -> Any:
        """Carries an action out and shows its result or the reason of its refusal; returns None after a refusal."""


class RunAccess:
    """Access of a page to the chosen run: a page always reads, and steers only in the role `STEER`."""

    def __init__(self, link: RunLink | RecordedLink, role: Role) -> None:
        self.link = link
        self.may_steer = role is Role.STEER and not link.recorded

    @property
    def name(self) -> str:
        """The name of the run."""
        return self.link.name

    async def steer(self, action: Action, names: Sequence[str], force: bool = False) -> dict[str, Any]:
        """Starts, stops, restarts, reloads, loads or unloads components; returns when it has happened.

        Args:
            action: the change.
            names: the components, or patterns.
            force: stops and unloads also the components that need them.

        Raises:
            ControlError: refused, or not permitted.
        """
        self._check()
        answer: dict[str, Any] = await self.link.ask("steer", _STEER_S, action=action, names=list(names), force=force)
        return answer

    async def clock(self, verb: str, **fields: Any) -> dict[str, Any]:
        """Pauses, resumes, steps, or sets the speed."""
        self._check()
        answer: dict[str, Any] = await self.link.ask(verb, _STEER_S, **fields)
        return answer

    async def set(self, changes: Sequence[str], save: bool = False) -> dict[str, Any]:
        """Changes settings, `NAME.SETTING=VALUE` each: all or none.

        Args:
            changes: the new values.
            save: first keeps them in the host-specific file beside the launch file, for later runs.

        Raises:
            ControlError: refused, or not permitted; nothing has changed in the run.
        """
        self._check()
        origin = "fwk web"
        if save:
            await self.link.ask("set", changes=list(changes), check=True)
            launch_file = (await self.link.about())["file"]
            await check_kept(launch_file, changes)
            file = host_file(Path(launch_file))
            try:
                await asyncio.to_thread(keep, file, [Kept.of(each) for each in changes])
            except KeepError as error:
                raise RefusedError(str(error)) from error
            origin = f"{origin}, {shown(file)}"
        answer: dict[str, Any] = await self.link.ask("set", changes=list(changes), origin=origin)
        return answer

    async def note(self, text: str) -> dict[str, Any]:
        """Writes a line into the log of the run."""
        self._check()
        answer: dict[str, Any] = await self.link.ask("note", text=text)
        return answer

    async def call(self, name: str, members: Mapping[str, Any], timeout_s: float = _CALL_S) -> dict[str, Any]:
        """Sends a command or a request, such as `house/pour`; returns its last answer within the time.

        The `state` of that is `done`, or `sent` or `accepted` while the component, or a paused run, lets it wait.

        Raises:
            ControlError: not permitted, refused, or the component could not carry it out; the text gives its reason.
        """
        self._check()
        kind = await self.link.message_type(service_channel(name, OUTSIDE))
        answer = await self.link.call(name, _encoded(kind, members, name), timeout_s)
        if answer["state"] not in _WELL:
            reason = f": {answer['reason']}" if answer["reason"] else ""
            raise RefusedError(f"{name}: {answer['state']}{reason}")
        return answer

    async def send(self, channel: str, members: Mapping[str, Any]) -> int:
        """Writes a message on a channel that the launch file opens for programs outside; returns its bytes."""
        self._check()
        about = await self.link.about()
        row = next((row for row in await self.link.channels() if row["channel"] == channel), None)
        if row is None or not row["outside"]:
            raise RefusedError(f"{channel}: programs outside may not write it; name it under 'outside:'")
        url = runs.public_bus(about)
        data = _encoded(await self.link.message_type(channel), members, channel)
        bus = PublicBus(url)
        bus.publish(channel, data)
        bus.close()
        return len(data)

    def _check(self) -> None:
        if not self.may_steer:
            raise RefusedError(
                f"{self.link.name} is a recording; branch it on the page Recordings"
                if self.link.recorded
                else "this console is for reading only; ask for a link that may steer"
            )


def _encoded(kind: Any, members: Mapping[str, Any], channel: str) -> bytes:
    try:
        return messages.encode(messages.of_dict(kind, members), channel)
    except messages.MessageError as error:
        raise RefusedError(str(error)) from error
