"""Meanings of settings: docstrings below fields, as shown to people and in JSON Schema."""

from dataclasses import dataclass

from pydantic import BaseModel, create_model

from fwk.component.config import Config
from fwk.component.meanings import DocumentedSchema, meanings_of


@dataclass
class Point:
    x_m: float = 0.0
    """Forward.

    Positive ahead.
    """


class Base(Config):
    gain: float = 0.3
    """Gain of the base."""
    plain: int = 1


class Tracker(Base):
    gain: float = 0.5
    """Gain of the tracker."""
    point: Point = Point()
    """Place of the sensor."""
    text: str = "a"
    "Any string literal will do."


def test_the_nearest_class_gives_the_meaning() -> None:
    assert meanings_of(Tracker) == {
        "gain": "Gain of the tracker.",
        "point": "Place of the sensor.",
        "text": "Any string literal will do.",
    }
    assert meanings_of(Base) == {"gain": "Gain of the base."}


def test_json_schema_describes_fields_also_in_dataclasses() -> None:
    made = Tracker.model_json_schema(schema_generator=DocumentedSchema)
    assert made["properties"]["gain"]["description"] == "Gain of the tracker."
    assert "description" not in made["properties"]["plain"]
    assert made["$defs"]["Point"]["properties"]["x_m"]["description"] == "Forward.\n\nPositive ahead."


def test_a_class_without_source_has_no_meanings() -> None:
    made: type[BaseModel] = create_model("Made", value=(int, 3))
    assert meanings_of(made) == {}
    assert meanings_of(create_model("Named", __base__=Base, more=(int, 3))) == {"gain": "Gain of the base."}
