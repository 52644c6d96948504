"""Plugins of `fwk play`: classes of the user that change, drop or invent messages."""

from collections.abc import Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from importlib import import_module
from typing import Any, Protocol

from fwk.lcm.event_log import Event
from fwk.lcm.messages import MessageError, encode
from fwk.lcm.type_registry import types_of

Played = tuple[str, bytes]
"""Channel and message."""


class PluginError(Exception):
    """A plugin cannot be used, or failed; the text names the plugin and the message."""


class PlayPlugin(Protocol):
    """Interface of a plugin: the patterns of its channels, and a method that gets each message of these channels."""

    channels: Sequence[str]

    def play(self, channel: str, message: Any, time_us: int) -> Iterable[tuple[str, Any]]:
        """Yields the messages that are played in the place of this one, each with its channel.

        Args:
            channel: the recorded channel.
            message: the decoded message.
            time_us: its time stamp in the log, in us.
        """
        ...


class Plugins:
    """Plugins in the order in which messages pass through them.

    Args:
        words: the plugins as `module:Class`.

    Raises:
        PluginError: a plugin cannot be imported, or lacks `channels` or `play`.
    """

    def __init__(self, words: Sequence[str] = ()) -> None:
        self._plugins = [(word, _made(word)) for word in words]

    def played(self, event: Event) -> list[Played]:
        """Returns the messages that the plugins make of a recorded one.

        Raises:
            PluginError: a plugin failed, or the type of a message for it is not known.
        """
        messages = [(event.channel, event.data)]
        for word, plugin in self._plugins:
            messages = [made for each in messages for made in _through(word, plugin, *each, event.time_us)]
        return messages


def _made(word: str) -> PlayPlugin:
    module, _, name = word.partition(":")
    if not module or not name:
        raise PluginError(f"'{word}' is not a plugin; write 'module:Class'")
    try:
        plugin: PlayPlugin = getattr(import_module(module), name)()
    except Exception as error:
        raise PluginError(f"plugin {word}: {type(error).__name__}: {error}") from error
    if isinstance(getattr(plugin, "channels", ""), str) or not callable(getattr(plugin, "play", None)):
        raise PluginError(
            f"plugin {word}: lacks 'channels', a tuple of channels or patterns, or a method "
            "'play(self, channel, message, time_us)' that yields (channel, message)"
        )
    return plugin


def _through(word: str, plugin: PlayPlugin, channel: str, data: bytes, time_us: int) -> Iterator[Played]:
    if not any(fnmatchcase(channel, pattern) for pattern in plugin.channels):
        yield channel, data
        return
    kinds = types_of(data)
    if not kinds:
        raise PluginError(
            f"plugin {word}: {channel}: a message of an unknown type (fingerprint {data[:8].hex()}); "
            "name the folder with its lcmtypes/ by --types"
        )
    try:
        for name, message in plugin.play(channel, kinds[0].decode(data), time_us):
            yield name, message if isinstance(message, bytes) else encode(message, name)
    except MessageError as error:
        raise PluginError(f"plugin {word}: {error}") from error
    except Exception as error:
        raise PluginError(f"plugin {word}: {channel} at {time_us} us: {type(error).__name__}: {error}") from error
