"""Turns `--set PATH=VALUE` into a layer of settings like that of a file."""

from collections.abc import Sequence

from fwk.model.errors import Problems, hint
from fwk.plan.files.settings import over
from fwk.plan.files.source import Node, read_value

PLACE = "--set"
SHARED = "shared"
"""Section of a launch file whose settings go to every component that has them."""
EXAMPLE = "write for example cyan1/omni_ball.least_fit=0.5"
RUN_KEYS = ("period_s", "clock", "speed", "seed", "stage_time_s", "loop_time_s", "loop_time_warnings", "public_url")


def overrides(sets: Sequence[str], problems: Problems) -> Node:
    """Returns the layer of all `--set` options, in the shape of a host file; later options win.

    A path is `cyan1/omni_ball.least_fit`, `*/camera.blur_px`, `shared.realism`, or a key of the run, `period_s`.
    """
    made = Node({}, PLACE)
    for text in sets:
        path, equals, value = text.partition("=")
        component, dot, setting = path.partition(".")
        if not equals or not path or (dot and not setting):
            problems.add(PLACE, "", f"'{text}' is not a PATH=VALUE; {EXAMPLE}")
        elif not dot and path not in RUN_KEYS:
            whole = f"the run has {', '.join(RUN_KEYS)}; write {SHARED}.{path} or NAME.{path} for components"
            right = "write NAME.SETTING=VALUE" if "/" in path else hint(path, RUN_KEYS, whole)
            problems.add(PLACE, "", f"no setting '{path}'; {right}")
        else:
            node = read_value(value, PLACE, problems)
            section = () if component == SHARED else ("config",)
            for key in reversed((*section, component, *setting.split(".")) if dot else (path,)):
                node = node and Node({key: node}, PLACE)
            made = over(made, node) if node else made
    return made
