"""The view of a device: its instrument, and over images of a camera the detections that views of projects draw."""

from collections.abc import Sequence
from typing import Any

from fwk.model.service_channels import is_of_service
from fwk.web.instruments import CAMERA, Instrument, instrument_of
from fwk.web.scene import Newest, Scene
from fwk.web.view import View
from fwk.web.words import seconds


class DeviceView(View):
    """Draws the newest message of a channel with the instrument of its type.

    Args:
        channel: the channel of the device.
        views: views whose `sight` is drawn over images.
    """

    def __init__(self, channel: str, views: Sequence[View] = ()) -> None:
        self.title = channel
        self._sights = [view for view in views if view.sees]
        space = channel.rpartition("/")[0]
        named = [name for view in self._sights for name in view.sees]
        self.channels = [channel, *(f"{space}/{name}" if space else name for name in named)]
        self.settings = [f"{space}/*.{name}" for view in self._sights for name in view.sight_settings]
        self._channel = channel

    def draw(self, newest: Newest, scene: Scene) -> None:
        """Draws the newest messages."""
        message = newest(self._channel)
        if message is None:
            scene.headline = f"{self._channel}: never written"
            return
        instrument = instrument_of(message.__slots__)
        if instrument is None:
            scene.headline = f"{self._channel}: no instrument shows its type"
            return
        instrument.draw(message, scene)
        scene.headline += _moment(message)
        if instrument is CAMERA:
            scene.picture(self._channel, message.frame, message.width_px, message.height_px)
            for view in self._sights:
                view.sight(self._channel, newest, scene)


def _moment(message: Any) -> str:
    """Returns when a device measured, in logical time; empty for types that do not say it."""
    header = getattr(message, "header", None)
    if header is None or not hasattr(header, "time_us"):
        return ""
    return f" (tick {header.tick}, {seconds(getattr(message, 'capture_us', 0) or header.time_us)})"


def devices_of(types: dict[str, Any]) -> dict[str, Instrument]:
    """Returns the channels that have an instrument, from the types of all channels."""
    found = {channel: instrument_of(kind.__slots__) for channel, kind in types.items() if not is_of_service(channel)}
    return {channel: instrument for channel, instrument in found.items() if instrument}
