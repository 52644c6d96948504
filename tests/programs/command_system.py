"""A small system with commands and requests: a lifter, a calculator, and two clients.

The lifter's messages show what it carried out: each command once, in the order in which it began them.
"""

from tests.harness.components import sources

LAUNCH = """
name: lift
speed: max
components:
  r/lifter: {{ use: "lift_parts:Lifter" }}
  r/adder: {{ use: "lift_parts:Adder" }}
  one/worker: {{ use: "lift_parts:Worker" }}
  two/worker: {{ use: "lift_parts:Worker" }}
public_url: "{public_url}"
"""


def command_system(public_url: str) -> dict[str, str]:
    """Returns the files of a user's folder."""
    return {
        **sources("lcmtypes/lift.lcm", "lift_parts.py", "weather.py"),
        "launch/lift.yaml": LAUNCH.format(public_url=public_url),
    }
