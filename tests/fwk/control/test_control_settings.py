"""Settings of a run: checked as in a launch file, shown with origin, type and meaning."""

import re
from collections.abc import Sequence
from typing import Annotated, Literal

import pytest
from pydantic import Field, ValidationInfo, field_validator

from fwk import Component, Config, Each, Reads, Writes, channel
from fwk.control.requests import RequestError
from fwk.control.settings import RunSettings
from fwk.testing.plans import plan_of
from lcmtypes.robot import imu_t


class Inner(Config):
    deep: int = Field(1, ge=0, lt=10)
    """Depth."""


class TurnerConfig(Config):
    gain: float = 0.3
    """Speed."""
    inner: Inner = Inner()
    names: list[str] = []
    table: dict[str, int] = {}
    fixed: Inner = Field(Inner(), frozen=True)
    fixed_table: dict[str, float] = Field({}, frozen=True)


class Turner(Component):
    stage = "think"
    config: TurnerConfig
    imu: Writes[imu_t]


class MixerConfig(Config):
    gains: dict[str, float] = {}

    @field_validator("gains")
    @classmethod
    def check(cls, gains: dict[str, float], info: ValidationInfo) -> dict[str, float]:
        known = info.context["channels"]["imus"] if info.context else ()
        for name in gains if info.context else ():
            if f"{name}/imu" not in known:
                raise ValueError(f"no robot '{name}'; there are: {', '.join(known)}")
        return gains


class Mixer(Component):
    stage = "think"
    config: MixerConfig
    imus: Each[Reads[imu_t]] = channel("*/imu")


class Plain(Component):
    stage = "think"
    imu: Writes[imu_t]


@pytest.fixture
def settings() -> RunSettings:
    plan = plan_of({"a/turner": Turner, "b/turner": Turner, "c/plain": Plain})
    for component in plan.components[:2]:
        component.origins.update({"gain": "soccer.yaml:4", "inner.deep": "default", "names": "default"})
        component.origins["fixed.deep"] = "default"
    return RunSettings(plan)


def apply(settings: RunSettings, *sets: str) -> None:
    for new in settings.check(sets):
        settings.take(new, "test")


def values(settings: RunSettings, pattern: str) -> dict[str, object]:
    return {f"{row['component']}.{row['setting']}": row["value"] for row in settings.rows([pattern])}


@pytest.mark.parametrize("typed", ["a/turner.every=2", "a/turner.offset=0", "*/plain.every=2"])
def test_every_and_offset_stay_as_they_are(settings: RunSettings, typed: str) -> None:
    """Launch files and --set have them among the settings."""
    name = typed.partition("=")[0].rpartition(".")[2]
    with pytest.raises(RequestError, match=f": '{name}' cannot change during a run; set it in the launch file"):
        settings.check([typed])


def test_a_fixed_setting_stays_as_it_is(settings: RunSettings) -> None:
    (row,) = settings.rows(["a/turner.fixed"])
    assert (row["setting"], row["editable"]) == ("fixed.deep", False)
    text = "a/turner: 'fixed.deep' cannot change during a run; set it in the launch file and restart"
    with pytest.raises(RequestError, match=re.escape(text)):
        settings.check(["a/turner.fixed.deep=2", "a/turner.gain=1"])
    assert [new.said for new in settings.check(["a/turner.fixed.deep=1"])] == [{"fixed.deep": 1}]


def test_a_fixed_mapping_gets_no_new_key(settings: RunSettings) -> None:
    text = "a/turner: 'fixed_table.new' cannot change during a run; set it in the launch file and restart"
    with pytest.raises(RequestError, match=re.escape(text)):
        settings.check(["a/turner.fixed_table.new=2"])


def test_a_row_has_all_columns(settings: RunSettings) -> None:
    assert settings.rows(["a/turner.gain"]) == [
        {
            "component": "a/turner",
            "setting": "gain",
            "value": 0.3,
            "origin": "soccer.yaml:4",
            "type": "float",
            "range": "",
            "meaning": "Speed.",
            "editable": True,
        }
    ]
    (deep,) = settings.rows(["b/turner.inner"])
    assert (deep["setting"], deep["type"], deep["meaning"]) == ("inner.deep", "int", "Depth.")
    assert deep["range"] == "at least 0, less than 10"


class TypesConfig(Config):
    share: Annotated[float, Field(ge=0.0, le=1.0)] | None = None
    """Meaning of two
    lines."""
    pair: tuple[Annotated[int, Field(le=255)], ...] = ()
    wheels: dict[str, tuple[Literal[1, 2], ...]] = {}
    inner: list[Inner] = []


class Types(Component):
    stage = "think"
    config: TypesConfig


def test_types_and_meanings_are_told_in_plain_words() -> None:
    plan = plan_of({"a/types": Types})
    plan.components[0].origins.update(dict.fromkeys(TypesConfig.model_fields, "default"))
    rows = {row["setting"]: row for row in RunSettings(plan).rows(["a/types"])}
    assert {name: row["type"] for name, row in rows.items()} == {
        "share": "float | None",
        "pair": "tuple[int, ...]",
        "wheels": "dict[str, tuple[1 | 2, ...]]",
        "inner": "list[Inner]",
    }
    assert (rows["share"]["range"], rows["share"]["meaning"]) == ("at least 0.0, at most 1.0", "Meaning of two lines.")


def test_new_values_show_their_origin_once_in_force(settings: RunSettings) -> None:
    found = settings.check(["*/turner.gain=1", "b/turner.inner.deep=7"])
    assert [new.said for new in found] == [{"gain": 1.0}, {"gain": 1.0, "inner.deep": 7}]
    assert values(settings, "*.gain") == {"a/turner.gain": 0.3, "b/turner.gain": 0.3}
    for new in found:
        settings.take(new, "test")
    assert values(settings, "b") == {
        "b/turner.gain": 1.0,
        "b/turner.inner.deep": 7,
        "b/turner.names": [],
        "b/turner.fixed.deep": 1,
    }
    origins = {f"{row['component']}.{row['setting']}": row["origin"] for row in settings.rows([])}
    assert origins["a/turner.gain"] == origins["b/turner.inner.deep"] == "test"
    assert origins["a/turner.inner.deep"] == "default"


def test_requests_before_the_boundary_add_up(settings: RunSettings) -> None:
    (first,) = settings.check(["a/turner.gain=1"])
    settings.ask(first)
    (second,) = settings.check(["a/turner.inner.deep=2"])
    assert second.values["gain"] == 1.0
    assert second.said == {"inner.deep": 2}


def test_a_restarted_process_gets_the_changes_to_the_plan(settings: RunSettings) -> None:
    assert settings.changed([0, 1]) == {}
    apply(settings, "b/turner.gain=2")
    assert list(settings.changed([0, 1])) == ["b/turner"]
    assert '"gain": 2.0' in settings.changed([1])["b/turner"]


@pytest.mark.parametrize(
    ("sets", "error"),
    [
        (["a/turner.gian=1"], "a/turner: no setting 'gian'; did you mean 'gain'?"),
        (["a/turner.inner.dep=1"], "a/turner: no setting 'inner.dep'; did you mean 'deep'?"),
        (["a/turner.gain=fast"], "a/turner: 'gain' is 'fast'; it should be a valid number"),
        (["a/turner.gain=true"], "it should be a number"),
        (["a/turnr.gain=1"], "no component 'a/turnr'; did you mean 'a/turner'?"),
        (["c/plain.gain=1"], "c/plain: no setting 'gain'; there is log_level"),
        (["speed=2"], "'speed=2' is not NAME.SETTING=VALUE; values of the run as a whole cannot change"),
        (["gain=2"], "'gain=2' is not NAME.SETTING=VALUE; write for example cyan1/omni_ball.least_fit=0.5"),
        (["turner.gain=2"], "no component 'turner'; did you mean 'a/turner'?"),
        (["b.turner.gain=2"], "'b' is not a component; did you mean 'b/turner'?"),
        (["shared.gain=2"], "'shared.gain=2' changes nothing; name the components that have it: NAME.SETTING=VALUE"),
        (
            ["a/turner.inner={}"],
            "a/turner: 'inner={}' changes nothing, because its keys keep their values; write inner.deep",
        ),
        (["a/turner.gain={}"], "a/turner: 'gain' is {}; it should be a valid number"),
        (["a/turner.bla={}"], "a/turner: no setting 'bla'"),
        (["a/turner.gain"], "'a/turner.gain' is not a PATH=VALUE"),
        (["a/turner.gain=[1"], "'[1' is not a YAML value"),
        (['a/turner.names=["\\ud800"]'], "is not a YAML value"),
        (["a/turner.gain=[1, " + "1" * 100], f"'[1, {'1' * 56}...' is not a YAML value"),
        (["a/turner.gain=1", "b/turner.names=[x, 1]"], "b/turner: 'names.1' is 1; it should be a valid string"),
    ],
)
def test_mistakes_are_named_and_nothing_changes(settings: RunSettings, sets: Sequence[str], error: str) -> None:
    before = settings.rows([])
    with pytest.raises(RequestError, match=re.escape(error)):
        settings.check(sets)
    assert settings.rows([]) == before


def test_all_mistakes_come_at_once(settings: RunSettings) -> None:
    with pytest.raises(RequestError) as raised:
        settings.check(["a/turner.gian=1", "nobody.x=2", "seed=3"])
    assert len(str(raised.value).splitlines()) == 3


@pytest.mark.parametrize(
    ("pattern", "error"),
    [
        ("a/turnr", "no component 'a/turnr'; did you mean 'a/turner'?"),
        ("a/turner.gian", "no setting 'a/turner.gian'; did you mean 'gain'?"),
        ("x.y", "no component 'x'; there are"),
        ("gain", "no component 'gain'; did you mean 'a/turner.gain'?"),
        ("a.turner.gain", "'a' is not a component; did you mean 'a/turner'?"),
    ],
)
def test_an_unknown_setting_is_named_with_the_nearest(settings: RunSettings, pattern: str, error: str) -> None:
    with pytest.raises(RequestError, match=re.escape(error)):
        settings.rows([pattern])


def test_a_config_is_updated_in_place() -> None:
    config = TurnerConfig()
    inner = config.inner
    config._take_over(TurnerConfig(gain=2, inner=Inner(deep=5), names=["x"]))
    assert (config.gain, config.names, inner.deep) == (2.0, ["x"], 5)
    assert config.inner is inner


def test_empty_table_can_be_set_while_it_is_empty(settings: RunSettings) -> None:
    (new,) = settings.check(["a/turner.table={}"])
    assert new.said == {"table": {}}
    settings.take(settings.check(["a/turner.table.x=3"])[0], "test")
    with pytest.raises(RequestError, match=re.escape("write table.x=VALUE")):
        settings.check(["a/turner.table={}"])


def test_validators_know_the_channels_of_the_component() -> None:
    settings = RunSettings(plan_of({"a/turner": Turner, "b/turner": Turner, "c/mixer": Mixer}))
    with pytest.raises(RequestError, match=re.escape("c/mixer: gains: no robot 'x'; there are: a/imu, b/imu")):
        settings.check(["c/mixer.gains.x=1"])
    (new,) = settings.check(["c/mixer.gains.b=1"])
    assert new.said == {"gains.b": 1.0}
