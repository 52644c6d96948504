"""Controls of a recording: slider, steps and play."""

from collections.abc import Callable
from typing import Any

from nicegui import ui

_PLAY_S = 0.1
_PLAY_TICKS = 2


class Transport:
    """Chooses a tick of a recording.

    Args:
        tick: the tick at first.
        last: the last tick.
        moved: called with each new tick.
    """

    def __init__(self, tick: int, last: int, moved: Callable[[int], Any]) -> None:
        self._last, self._moved = last, moved
        with ui.row().classes("items-center w-full no-wrap"):
            back = ui.button(icon="skip_previous").props('flat dense aria-label="one tick back"')
            self._play = ui.button(icon="play_arrow").props('flat dense aria-label="play"')
            on = ui.button(icon="skip_next").props('flat dense aria-label="one tick on"')
            self._slider = ui.slider(min=1, max=max(1, last), value=tick).props('aria-label="tick"').classes("col")
            self._clock = ui.label(f"tick {tick}").classes("fwk-clock").props("data-name=tick")
        self._timer = ui.timer(_PLAY_S, self._advance, active=False)
        self._slider.on_value_change(self._show)
        self._play.on_click(self._play_or_stop)
        back.on_click(lambda: self.go(self.tick - 1))
        on.on_click(lambda: self.go(self.tick + 1))

    @property
    def tick(self) -> int:
        """The chosen tick."""
        return int(self._slider.value)

    def go(self, tick: int) -> None:
        """Chooses a tick; the nearest one if the recording does not have it."""
        self._slider.set_value(min(self._last, max(1, tick)))

    def _show(self) -> None:
        self._clock.set_text(f"tick {self.tick}")
        self._moved(self.tick)

    def _advance(self) -> None:
        self.go(self.tick + _PLAY_TICKS)
        if self.tick >= self._last:
            self._play_or_stop()

    def _play_or_stop(self) -> None:
        self._timer.active = not self._timer.active
        self._play.props(f"icon={'pause' if self._timer.active else 'play_arrow'}")
