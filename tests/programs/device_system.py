"""A small system around a device with LCM types of its own: a driver, and a listener that sums up its messages."""

from tests.harness.components import sources

LAUNCH = """
name: device
{time}
components:
  r/driver: {{ use: "device_parts:Driver", restart: {{ backoff_s: 0.01 }} }}
  s/listener: {{ use: "device_parts:Listener" }}
outside:
  JOYSTICK: devices.joy_t
public_url: "{public_url}"
"""


def device_system(public_url: str, time: str = "period_s: 0.02") -> dict[str, str]:
    """Returns the files of a user's folder."""
    return {
        **sources("lcmtypes/devices.lcm", "device_parts.py"),
        "device.yaml": LAUNCH.format(time=time, public_url=public_url),
    }
