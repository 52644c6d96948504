"""Keys and status line of `fwk play`."""

from fwk.clock import speed_word
from fwk.recording.play.player import FASTEST, Player
from fwk.recording.play.timeline import MomentError

KEYS = "space pause  s step  ←→ 1 s  ↑↓ 10 s  g go to  +- speed  m max  l loop  q quit"
_JUMPS_S = {"left": -1.0, "right": 1.0, "down": -10.0, "up": 10.0}
_ERASE = ("\x7f", "\x08")


class Controls:
    """Carries out what is typed while a log is played."""

    def __init__(self, player: Player) -> None:
        self.player = player
        self.quits = False
        """Whether the user wants to end."""
        self.said = ""
        """Answer to the last key."""
        self._typed: str | None = None  # the moment that is being typed; None: keys are commands

    def press(self, key: str, now_us: int) -> bool:
        """Carries out a key; returns whether it asks for the rest of the present tick."""
        player, self.said = self.player, ""
        if self._typed is not None:
            self._type(key, now_us)
        elif key == "q":
            self.quits = True
        elif key == "g":
            self._typed = ""
        elif key in ("space", "p"):
            player.resume(now_us) if player.paused else player.pause()
        elif key == "l":
            player.loop = not player.loop
            self.said = "loop" if player.loop else "no loop"
        elif key in ("+", "=", "-"):
            player.set_speed((player.speed or 1.0) * (0.5 if key == "-" else 2.0), now_us)
        elif key == "m":
            player.set_speed(FASTEST, now_us)
        elif key in _JUMPS_S:
            player.seek_by(_JUMPS_S[key], now_us)
        return key == "s" and self._typed is None

    def line(self) -> str:
        """Returns the status line."""
        player = self.player
        if self._typed is not None:
            return f"go to tick, time (12.5s) or bookmark: {self._typed}"
        if self.said:
            return self.said
        return f"{self.position()}{', paused' if player.paused else ''}, {player.messages} messages   {KEYS}"

    def position(self) -> str:
        """Returns tick, time and speed."""
        player, timeline = self.player, self.player.timeline
        where = f"tick {player.tick}, " if player.tick is not None else ""
        seconds = f"{timeline.seconds(player.time_us):.2f} of {timeline.length_s:.2f} s"
        return f"{where}{seconds}, speed {speed_word(player.speed)}"

    def _type(self, key: str, now_us: int) -> None:
        assert self._typed is not None
        if key in _ERASE:
            self._typed = self._typed[:-1]
        elif key == "enter":
            try:
                self.player.seek(self.player.timeline.find(self._typed), now_us)
            except MomentError as error:
                self.said = str(error).removeprefix(f"{self.player.timeline.path}: ")
            self._typed = None
        elif key == "escape":
            self._typed = None
        else:
            self._typed += " " if key == "space" else key if len(key) == 1 else ""
