"""A small system that programs outside take part in: a component sums up the values of a joystick."""

from tests.harness.components import sources

LAUNCH = """
name: joystick
{time}
components:
  r/obeys: {{ use: "obeys_parts:Obeys" }}
  s/obeys: {{ use: "obeys_parts:Obeys", channels: {{ wish: r/wish }} }}
outside:
  r/wish: robot.motor_command_t
public_url: "{public_url}"
"""


def outside_system(public_url: str, time: str) -> dict[str, str]:
    """Returns the files of a user's folder."""
    return {
        **sources("obeys_parts.py", "weather.py"),
        "joystick.yaml": LAUNCH.format(time=time, public_url=public_url),
    }
