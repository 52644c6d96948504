"""The architecture page shows the layers that import-linter checks."""

import re
import tomllib

from tests.docs.docs_pages import ROOT, blocks

PAGE = ROOT / "docs" / "architecture.md"


def layers() -> list[list[str]]:
    """Returns the layers of the framework from top to bottom, each with the packages on the same level."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
    (found,) = [contract["layers"] for contract in contracts if contract.get("containers") == ["fwk"]]
    return [layer.split(" | ") for layer in found]


def test_the_table_has_the_layers_in_order() -> None:
    rows = re.findall(r"^\| ([a-z_]+) \|", PAGE.read_text().partition("| layer | responsibility |")[2], re.M)
    assert rows == [package for level in layers() for package in level]


def test_the_drawing_has_the_layers_in_order() -> None:
    drawing = blocks(PAGE)[-1].text
    inside = drawing.partition("subgraph fwk")[2].partition("end\n")[0]
    places = [re.search(rf"\b{package}\b", inside) for level in layers() for package in level]
    assert None not in places
    assert [place.start() for place in places if place] == sorted(place.start() for place in places if place)
