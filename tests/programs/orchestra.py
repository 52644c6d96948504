"""A small system that uses all of the contract at once: the notes of its players hold what they heard.

Six players in five stages hear all players, including themselves; `d` and `e` share a stage, `a` takes part in two.
Each writes one note in each iteration and none to three bursts; the bursts of `b` are larger than a datagram. The
conductor is the time source; its ticks differ in length. A camera publishes frames, a viewer looks at them. Settings
give a player faults (`trouble.py`), and let all processes lose datagrams (`weather.py`).
"""

from tests.harness.components import sources

LAUNCH = """
name: orchestra
speed: max
components:
  world/conductor: {{ use: "player:Conductor" }}
  a/player: {{ use: "player:Player", stage: [sensor_prepare, act] }}
  b/player: {{ use: "player:Player", stage: sensor_acquire, config: {{ ballast: 100000 }} }}
  c/player: {{ use: "player:Player", stage: worldstate }}
  d/player: {{ use: "player:Player" }}
  e/player: {{ use: "player:Player", config: {{ work: 5 }} }}
  f/player: {{ use: "player:Player", stage: post_loop }}
  a/camera: {{ use: "vision_parts:Camera" }}
  a/viewer: {{ use: "vision_parts:Viewer" }}
public_url: "{public_url}"
"""

PLAYERS = "abcdef"
STAGES = {"a": (2, 7), "b": (1,), "c": (4,), "d": (5,), "e": (5,), "f": (9,)}
"""Player to the indices of its stages."""

GROUPS = """
hosts:
  strings: [a/player, c/player, e/player]
  brass: [b/player, a/camera, world/conductor]
"""


def orchestra(public_url: str, more: str = "") -> dict[str, str]:
    """Returns the files of a user's folder; `more` is added to the launch file."""
    return {
        **sources("lcmtypes/play.lcm", "player.py", "vision_parts.py", "trouble.py", "weather.py"),
        "launch/orchestra.yaml": LAUNCH.format(public_url=public_url) + more,
    }
