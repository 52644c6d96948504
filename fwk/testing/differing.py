"""Differences between campaigns: digests of their plans, and the difference in the words of the command line."""

import hashlib
import json
from collections.abc import Mapping
from typing import Any

from fwk.model.plan import Plan
from fwk.testing.executors import CampaignError
from fwk.testing.launched import launch_plan

_TYPED = {"time_s": "--time", "sets": "--set", "file": "the launch file", "by": "the evaluation"}
"""Names of options and parts of the launch file that a user knows, by the keys of a campaign's note."""
_DIGESTS = ("plan", "run")
"""Keys of digests, which say nothing: of components and their settings, and of the run's own settings."""
_checked: dict[tuple[str, tuple[str, ...]], str] = {}
"""Digest of the plan that this process plays of a launch file with settings that are overridden."""


def digests_of(plan: Plan) -> dict[str, str]:
    """Returns a digest of stages and components with all of their settings, and one of the run's own settings.

    Runs of other components are not mixed in. The settings of the run tell whether those typed with --set do the same.
    """
    played = [
        (
            *(each.name, each.module, each.class_name, each.config, each.channels),
            *(each.stages, each.rate_hz, each.every, each.offset),
        )
        for each in plan.components
    ]
    paced = (plan.clock, plan.speed, plan.stage_time_us, plan.loop_time_us, plan.loop_time_warnings, plan.public_url)
    return {"plan": digest_of((plan.period_us, plan.stages, played)), "run": digest_of(paced)}


def digest_of(value: Any) -> str:
    """Returns the beginning of a hash of the value as Python writes it."""
    return hashlib.sha256(repr(value).encode()).hexdigest()[:16]


def check_plan(file: str, sets: tuple[str, ...], digest: str) -> None:
    """Has this process play a launch file as it is now, and checks that this is the plan of the campaign.

    A worker of a cluster outlives campaigns, and may have played the file before it was changed.

    Raises:
        CampaignError: the plan has another digest.
        PlanError: the file has mistakes.
    """
    if _checked.get((file, sets)) == digest:
        return
    launch_plan.cache_clear()
    found = _checked[file, sets] = digests_of(launch_plan(file, sets))["plan"]
    if found != digest:
        cure = "type the command again, after copying the file to the machines of the workers if they have their own"
        raise CampaignError(f"{file} has other components or settings than at the start of the evaluation; {cure}")


def differing(old: Mapping[str, Any], new: Mapping[str, Any]) -> str:
    """Returns how another campaign differs from this one: `--time is 60 there, 30 here`; empty if it does not.

    Settings that lead to the same plan and the same run are no difference, however they were typed.
    """
    keys = [key for key in {**old, **new} if key != "run" and old.get(key) != new.get(key)]
    if not keys or (keys == ["sets"] and _mean_the_same(old, new)):
        return ""
    shown = [key for key in keys if key not in _DIGESTS]
    if not shown:
        return "its launch file had other components or settings"
    return ", ".join(
        f"{_TYPED.get(key, key)} is {_said(old.get(key))} there, {_said(new.get(key))} here" for key in shown
    )


def _mean_the_same(old: Mapping[str, Any], new: Mapping[str, Any]) -> bool:
    """Returns whether settings lead to the same run; a note of former code says so only if they were typed alike."""
    if None not in (old.get("plan"), old.get("run")):
        return bool(old["run"] == new.get("run"))
    return _sorted(old.get("sets")) == _sorted(new.get("sets"))


def _sorted(values: Any) -> list[str]:
    """Returns the values of a list in an order of their own; of anything else itself."""
    return sorted(map(str, values)) if isinstance(values, list) else [str(values)]


def _said(value: Any) -> str:
    """Returns a value as it was typed."""
    if isinstance(value, list):
        return " ".join(map(str, value)) or "none"
    if isinstance(value, float):
        return str(value).removesuffix(".0")
    return "none" if value is None else value if isinstance(value, str) else json.dumps(value)
