"""`fwk play RUN`: gives a recording, or a log of lcm-logger, back to the public bus."""

import json
import select
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from fwk.bus.public import PublicBus
from fwk.cli.arguments import speed
from fwk.cli.recordings.find_log import failing, find_log_with_types
from fwk.cli.recordings.log_options import Types
from fwk.cli.recordings.play_controls import Controls
from fwk.cli.recordings.user_folders import use_folders
from fwk.cli.run_options import Json
from fwk.clock import US_PER_S, monotonic_us
from fwk.display.keys import Keyboard
from fwk.display.table import cells, terminal_width
from fwk.gateway.pacing import PacedPublisher
from fwk.lcm.event_log import Event
from fwk.model.plan import Plan
from fwk.model.public_url import UrlError
from fwk.program import BAD_INPUT, FAILED, INTERRUPTED
from fwk.recording.play.channels import Channels
from fwk.recording.play.player import Player
from fwk.recording.play.plugins import PluginError, Plugins
from fwk.recording.play.timeline import Moment, MomentError, Timeline

_LISTENER_PATIENCE_US = 2 * US_PER_S
_REDRAW_US = US_PER_S // 10
_LOOK_US = US_PER_S // 10

_Patterns = list[str] | None


def play(
    run: Annotated[Path, typer.Argument(metavar="RUN_OR_LOG", help="a run directory, its name, or a log")],
    pace: Annotated[
        float, typer.Option("--speed", parser=speed, metavar="F|max", help="logged seconds in a second")
    ] = 1.0,
    begin: Annotated[
        str, typer.Option("--from", metavar="MOMENT", help="begin at a tick (1200), a time (12.5s) or a 'fwk note'")
    ] = "",
    end: Annotated[str, typer.Option("--to", metavar="MOMENT", help="end after this tick, time or 'fwk note'")] = "",
    loop: Annotated[bool, typer.Option("--loop", help="begin again at the end")] = False,
    paused: Annotated[bool, typer.Option("--paused", help="begin with a pause, in a terminal")] = False,
    wait: Annotated[bool, typer.Option("--wait", help="begin when a program listens on the bus")] = False,
    channels: Annotated[
        _Patterns, typer.Option("--channels", metavar="PATTERN", help="only these, such as 'cyan1/*'; repeatable")
    ] = None,
    exclude: Annotated[
        _Patterns, typer.Option("--exclude", metavar="PATTERN", help="all but these channels; repeatable")
    ] = None,
    remap: Annotated[_Patterns, typer.Option(metavar="A=B", help="play channel A as channel B; repeatable")] = None,
    plugin: Annotated[
        _Patterns, typer.Option(metavar="MODULE:CLASS", help="class that changes messages; repeatable")
    ] = None,
    url: Annotated[str, typer.Option(metavar="URL", help="the public bus")] = Plan.public_url,
    types: Types = Path(),
    as_json: Json = False,
) -> None:
    """Gives a recording, or a log of lcm-logger, back to the public bus: the same channels, bytes and order.

    In a terminal keys pause, step, jump and change the speed. Ctrl-C ends.

    Exit codes: 0 played; 1 a plugin or the bus failed; 2 bad input.
    """
    with failing(BAD_INPUT):
        use_folders([str(types)])
        timeline = Timeline(find_log_with_types(run, types))
        try:
            chosen = Channels(channels or (), exclude or (), _names(remap or ()))
            plugins = Plugins(plugin or ())
            start, stop = timeline.find(begin) if begin else None, _after(timeline, end)
            if start and stop and stop.position <= start.position:
                raise ValueError(f"--from {begin} comes after --to {end}; nothing to play")
            if paused and not Keyboard().descriptors:
                raise ValueError("--paused needs a terminal, whose keys end the pause")
            bus = PublicBus(url)
        except (ValueError, PluginError, MomentError, UrlError) as error:
            _complain(error, BAD_INPUT)
        except OSError as error:
            _complain(f"the bus {url} cannot be opened: {error.strerror}; 'fwk doctor' says what to type", FAILED)
    player = Player(timeline, monotonic_us(), pace, start, stop, loop, paused)
    with Keyboard() as keyboard:
        playing = _Playing(player, bus, chosen, plugins, keyboard)
        try:
            playing.play(wait)
        except PluginError as error:
            playing.clear_line()
            _complain(error, FAILED)
        except KeyboardInterrupt as interrupt:
            raise typer.Exit(INTERRUPTED) from interrupt
        finally:
            playing.clear_line()
            bus.close()
    played = {
        "messages": playing.messages,
        "heard": playing.heard,
        "rounds": player.rounds,
        "listener_too_slow": playing.overrun,
    }
    if playing.overrun:
        typer.echo(f"public bus: {playing.overrun} does not keep up; it may lack messages", err=True)
    unheard = "" if playing.heard or not playing.messages else "; no program listened: start one before, or add --wait"
    typer.echo(json.dumps(played) if as_json else f"{playing.messages} messages played on {url}{unheard}")


class _Playing:
    """A player with its bus and its terminal."""

    def __init__(
        self, player: Player, bus: PublicBus, channels: Channels, plugins: Plugins, keyboard: Keyboard
    ) -> None:
        self.messages = 0
        self.heard = False
        """Whether a program could listen to some of the messages."""
        self._player, self._bus, self._channels, self._plugins = player, bus, channels, plugins
        self._publisher = PacedPublisher(monotonic_us, self._send, bus.busy_listeners, _LISTENER_PATIENCE_US)
        self._controls = Controls(player)
        self._keyboard = keyboard
        self._shows = bool(keyboard.descriptors) and sys.stdout.isatty()
        self._drawn = ""
        self._redraw_us = 0

    @property
    def overrun(self) -> str:
        """Listener that did not keep up; empty: none."""
        return self._publisher.overrun

    def play(self, wait: bool) -> None:
        """Plays to the end, or until the user quits; with `wait`, begins when a program listens.

        Raises:
            PluginError: a plugin failed.
        """
        if wait and self._bus.busy_listeners() is None:
            self._say("waits until a program listens")
        while wait and self._bus.busy_listeners() is None and not self._controls.quits:
            self._sleep(monotonic_us() + _LOOK_US)
        self._say("plays from here")
        self._player.resume(monotonic_us()) if not self._player.paused else None
        while not self._controls.quits and not (self._player.ended and not self._publisher.waiting):
            if not self._publisher.waiting:  # a tick begins when the one before has left
                self._publish(self._player.due(monotonic_us()))
            self._publisher.send_due()
            due_us = self._publisher.due_us if self._publisher.waiting else self._player.due_us()
            self._sleep(due_us)
            if self._shows and monotonic_us() >= self._redraw_us:
                self._draw()

    def _publish(self, events: Iterable[Event]) -> None:
        for event in events:
            if self._channels.takes(event.channel, event.data):
                for channel, data in self._plugins.played(event):
                    self._publisher.put(self._bus.datagrams(*self._channels.renamed(channel, data)))
                    self.messages += 1
        self._publisher.tick()

    def _send(self, datagram: bytes) -> None:
        self.heard = True
        self._bus.send(datagram)

    def _sleep(self, until_us: int) -> None:
        """Waits, at most until the status line is due; carries out the keys that are pressed meanwhile."""
        if self._player.ended and not self._publisher.waiting:
            return
        limit_us = _REDRAW_US if self._shows else US_PER_S
        wait_us = min(until_us - monotonic_us(), limit_us)
        ready, _, _ = select.select(self._keyboard.descriptors, [], [], max(0.0, wait_us / US_PER_S))
        for key in self._keyboard.read() if ready else ():
            if self._controls.press(key, monotonic_us()):
                self._publish(self._player.step(monotonic_us()))
            self._redraw_us = 0

    def _say(self, what: str) -> None:
        """Says on stderr what begins, where no status line does: in a pipe or a file."""
        if not self._shows:
            name = self._player.timeline.path.name
            typer.echo(f"{name}: {self._controls.position()}: {what}; Ctrl-C ends", err=True)

    def _draw(self) -> None:
        self._redraw_us = monotonic_us() + _REDRAW_US
        line = self._controls.line()
        while cells(line) >= (terminal_width() or sys.maxsize):
            line = line[:-1]
        if line != self._drawn:
            sys.stdout.write(f"\r{line}\x1b[K")
            sys.stdout.flush()
            self._drawn = line

    def clear_line(self) -> None:
        """Removes the status line."""
        if self._drawn:
            sys.stdout.write("\r\x1b[K")
            sys.stdout.flush()
            self._drawn = ""


def _after(timeline: Timeline, text: str) -> Moment | None:
    """Returns the end of the tick at a moment; None: the log ends with it."""
    return timeline.after(timeline.find(text).position) if text else None


def _names(remap: Iterable[str]) -> dict[str, str]:
    """Returns new names by former ones.

    Raises:
        ValueError: an entry is not `A=B`.
    """
    names: dict[str, str] = {}
    for text in remap:
        old, equals, new = text.partition("=")
        if not (old and equals and new):
            raise ValueError(f"--remap '{text}': write A=B, the recorded channel and its new name")
        if names.setdefault(old, new) != new:
            raise ValueError(f"--remap: {old} cannot be both {names[old]} and {new}")
    return names


def _complain(error: object, code: int) -> NoReturn:
    typer.echo(f"error: {error}", err=True)
    raise typer.Exit(code)
