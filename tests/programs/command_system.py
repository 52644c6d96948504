"""A small system with commands and requests: a lifter that carries out, a calculator that answers, two that want it.

What was carried out stands in what the lifter writes: each command once, in the order in which it was begun.
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
    """The files of a user's folder."""
    return {
        **sources("lcmtypes/lift.lcm", "lift_parts.py", "weather.py"),
        "launch/lift.yaml": LAUNCH.format(public_url=public_url),
    }
