"""Documents of tests: YAML with the lines of its mistakes."""

import pytest
from pydantic import BaseModel, ConfigDict

from fwk.testing import Document, PlanError


class Part(BaseModel):
    model_config = ConfigDict(extra="forbid")

    size_m: float = 1.0


class Whole(BaseModel):
    name: str = ""
    parts: dict[str, dict[str, float]] = {}


TEXT = "name: it\nparts:\n  first: {size_m: 2}\n  second: {sice_m: 3}\n"


def test_values_below_a_path_have_their_lines() -> None:
    document = Document(TEXT, "it.yaml")
    assert document.values(Whole) == Whole(name="it", parts={"first": {"size_m": 2}, "second": {"sice_m": 3}})
    assert document.values(Part, "parts", "first") == Part(size_m=2.0)
    assert document.values(Part, "parts", "third") == Part()
    document.raise_mistakes()
    document.values(Part, "parts", "second", who="second", what="setting")
    document.add("parts: too few", "parts")
    document.add("elsewhere: nothing", "elsewhere")
    with pytest.raises(PlanError) as raised:
        document.raise_mistakes()
    assert str(raised.value).splitlines() == [
        "it.yaml:1: elsewhere: nothing",
        "it.yaml:2: parts: too few",
        "it.yaml:4: second: no setting 'sice_m'; did you mean 'size_m'?",
    ]


def test_text_that_is_not_yaml_is_refused() -> None:
    with pytest.raises(PlanError, match=r"it.yaml:2: this is not valid YAML"):
        Document("name: it\nparts: [", "it.yaml")
