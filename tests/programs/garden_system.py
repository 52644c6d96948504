"""A system of 105 components for the console: a mower with a camera that is watched, and a crowd in one process."""

from tests.harness.components import sources

CROWD = 100
LAUNCH = """
name: garden
period_s: 0.1
components:
  a/mower: {{ use: "garden_parts:Mower" }}
  a/eye: {{ use: "garden_parts:Eye" }}
  a/watcher: {{ use: "garden_parts:Watcher" }}
  a/probe: {{ use: "garden_parts:Probe" }}
  b/later: {{ use: "garden_parts:Watcher", start: false }}
{crowd}
outside: {{ garden/wish: garden.wish_t, garden/hint: garden.wish_t, garden/stick: robot.joystick_t }}
hosts: {{ crowd: [{names}] }}
public_url: "{public_url}"
"""


def garden_system(public_url: str) -> dict[str, str]:
    """Returns the files of a user's folder."""
    names = [f"crowd/n{number:03}" for number in range(CROWD)]
    crowd = "\n".join(f'  {name}: {{ use: "idle:Idle" }}' for name in names)
    launch = LAUNCH.format(crowd=crowd, names=", ".join(names), public_url=public_url)
    return {
        **sources("lcmtypes/garden.lcm", "garden_parts.py", "garden_web.py", "idle.py"),
        "launch/garden.yaml": launch,
    }
