"""Merges layers of settings and gives the origin of each effective value."""

from collections.abc import Callable, Sequence
from typing import Any

from fwk.component.config import Config
from fwk.plan.files.source import Node
from fwk.plan.files.validation import Path, validated

DEFAULT = "default"


def effective(
    config: type[Config], layers: Sequence[Node], place: str, report: Callable[[str, str], None]
) -> tuple[dict[str, Any], dict[str, str]]:
    """Returns the settings of a component, and the origin of each setting by its dotted name.

    Later `layers` win, key by key. Mistakes go to `report` as place and text; a missing setting is reported at the
    component's `place`.
    """
    given = Node({}, place)
    for layer in layers:
        given = over(given, layer)

    def mistake(path: Path, where: str, text: str) -> None:
        report(where if path else place, text)

    try:
        checked = validated(config, given, mistake, "setting")
        values = checked[0].model_dump(mode="json") if checked else {}
    except Exception as error:  # of a validator of the component's own
        report(place, f"its settings cannot be checked: {type(error).__name__}: {error}")
        return {}, {}
    return values, _origins(values, given, "")


def over(below: Node, above: Node) -> Node:
    """Returns `above` laid over `below`: mappings key by key, any other value as a whole."""
    if not isinstance(below.value, dict) or not isinstance(above.value, dict):
        return above
    merged = dict(below.value)
    for key, node in above.value.items():
        merged[key] = over(merged[key], node) if key in merged else node
    return Node(merged, above.place)


def _origins(values: dict[str, Any], given: Node | None, prefix: str) -> dict[str, str]:
    found: dict[str, str] = {}
    for key, value in values.items():
        node = given
        if given and isinstance(given.value, dict):
            node = given.value.get(key)
        if isinstance(value, dict) and value:
            found |= _origins(value, node, f"{prefix}{key}.")
        else:
            found[prefix + key] = node.place if node else DEFAULT
    return found
