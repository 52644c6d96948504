"""Checks that all components have the same value of a setting whose type is marked with `Alike`."""

import json
from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import Any

from fwk.component.config import Alike
from fwk.model.errors import Problems
from fwk.plan.files.settings import DEFAULT
from fwk.plan.resolve import Resolved

_MISSING = "missing"


def check_alike(components: Sequence[Resolved], problems: Problems) -> None:
    """Reports components with another value than most have; of values that are as frequent, the first is right."""
    owners: dict[str, list[Resolved]] = defaultdict(list)
    for component in components:
        for name, field in component.declaration.config.model_fields.items():
            if Alike in field.metadata:
                owners[name].append(component)
    for setting, found in owners.items():
        texts = [json.dumps(each.config[setting], sort_keys=True) for each in found]
        usual = max(texts, key=texts.count) if len(set(texts)) > 1 else texts[0]
        first, others = found[texts.index(usual)], texts.count(usual) - 1
        more = f" and {others} more" if others else ""
        for component, text in zip(found, texts, strict=True):
            if text != usual:
                right = f"{more}; all components have to agree: state it once, under 'shared:'"
                report_differences(setting, first, component, right, problems)


def report_differences(setting: str, first: Resolved, second: Resolved, right: str, problems: Problems) -> None:
    """Reports each value of a setting that is not the same in two components, where a file has it; `right` follows."""
    for key, theirs, ours in _differences(setting, first.config[setting], second.config[setting]):
        place, who = next(
            (
                (place, each.asked.name)
                for each in (second, first)
                for name, place in each.origins.items()
                if f"{name}.".startswith(f"{key}.") and place != DEFAULT
            ),
            (second.asked.node.place, second.asked.name),
        )
        text = f"'{key}' is {ours} in {second.asked.name}, but {theirs} in {first.asked.name}"
        problems.add(place, who, text + right)


def _differences(path: str, theirs: Any, ours: Any) -> Iterator[tuple[str, Any, Any]]:
    if isinstance(theirs, dict) and isinstance(ours, dict):
        for name in {**ours, **theirs}:
            yield from _differences(f"{path}.{name}", theirs.get(name, _MISSING), ours.get(name, _MISSING))
    elif theirs != ours:
        yield path, theirs, ours
