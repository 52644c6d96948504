"""Mistakes in components that the check reports: settings, templates, names."""

from pathlib import Path

from tests.fwk.plan.plan_mistakes import Broken, expected, rows, said


@rows(
    Broken(
        """
        it.yaml:4: it/wheels: no setting 'gian'; did you mean 'gain'?
        it.yaml:5: it/wheels: 'count' is 'three'; it should be a valid integer, unable to parse string as an integer
        it.yaml:6: it/wheels: 'brake' is 1; it should be true or false
        it.yaml:7: it/wheels: 'mode' is 'sfot'; it should be 'soft' or 'hard'
        it.yaml:8: it/wheels: 'label' is 5; it should be a valid string
        it.yaml:10: it/wheels: 'limits.speed_m_s' is true; it should be a number
        it.yaml:11: it/wheels: no setting 'limits.trns'; did you mean 'turns'?
        it.yaml:14: it/wheels2: 'gain' is 1.5; it should be less than or equal to 1
        it.yaml:14: it/wheels2: 'limits.turns' is [1]; it should be longer
        """,
        """
        components:
          it/pilot: {use: plan_parts:Pilot}
          it/wheels: {use: plan_parts:Wheels, config: {
            gian: 0.3,
            count: three,
            brake: 1,
            mode: sfot,
            label: 5,
            limits: {
              speed_m_s: true,
              trns: [1, 2]
              }
            }}
          it/wheels2: {use: plan_parts:Wheels, channels: {odometry: two}, config: {gain: 1.5, limits: {turns: [1]}}}
        """,
    ),
    Broken(
        """
        it.yaml:4: it/a: 'colour' is 5; it should be a list such as [1, 2]
        it.yaml:5: it/a: 'names' is 'x'; it should be a list such as ['x']
        it.yaml:6: it/a: 'others' is 5; it should be a list such as ['a', 'b']
        it.yaml:7: it/a: 'words' is empty; it should be a list such as ['a', 'b']
        it.yaml:8: it/a: 'weights' is 2; it should be a list such as [2]
        it.yaml:9: it/a: 'seen' is 'maybe'; it should be true or false
        """,
        """
        components:
          it/a:
            use: strange:Seer
            config: {colour: 5,
              names: x,
              others: 5,
              words: ,
              weights: 2,
              seen: maybe}
        --- strange.py
        from fwk import Component, Config
        class Sight(Config):
            colour: tuple[int, int] = (1, 2)
            names: list[str] = []
            others: set[str] = set()
            words: tuple[str, ...] = ()
            weights: list[float] = []
            seen: bool = True
        class Seer(Component):
            stage = "think"
            config: Sight
        """,
    ),
    Broken(
        "it.yaml:2: it/a: 'colour.0' is 300; it should be less than or equal to 179",
        """
        components:
          it/a: {use: strange:Seer, config: {colour: [300, 255, 255]}}
        --- strange.py
        from typing import Annotated
        from fwk import Component, Config, Field
        class Sight(Config):
            colour: tuple[Annotated[int, Field(le=179)], int, int] = (1, 2, 3)
        class Seer(Component):
            stage = "think"
            config: Sight
        """,
    ),
    Broken(
        """
        it.yaml:2: 'components.a/a.every' is 'two'; it should be a whole number from 1 to 1000000
        it.yaml:3: 'components.b/b.every' is 0; it should be a whole number from 1 to 1000000
        it.yaml:4: 'components.c/c.every' is 2.0; it should be a whole number from 1 to 1000000
        it.yaml:5: 'components.d/d.every' is '2'; it should be a whole number from 1 to 1000000
        it.yaml:6: it/c: 'limits.turns' is [1, 2, 3]; it should have at most 2 values
        """,
        """
        components:
          a/a: {use: plan_parts:Odometer, every: two}
          b/b: {use: plan_parts:Odometer, every: 0}
          c/c: {use: plan_parts:Odometer, every: 2.0}
          d/d: {use: plan_parts:Odometer, every: "2"}
          it/c: {use: plan_parts:Wheels, config: {limits: {turns: [1, 2, 3]}}}
          it/pilot: {use: plan_parts:Pilot}
        """,
    ),
    Broken(
        """
        it.yaml:3: it/b: gains: no robot 'y'; there is r
        it.yaml:5: it/a: gains: no robot 'x'; there is r
        """,
        """
        components:
          r/motor: {use: plan_parts:Odometer}
          it/b: {use: strange:Mixer}
          it/a: {use: strange:Mixer, config: {gains: {
            x: 1.0}}}
        --- strange.py
        from fwk import Component, Config, Each, Reads, channel
        from lcmtypes.robot import odometry_t
        from pydantic import ValidationInfo, field_validator
        class Gains(Config):
            gains: dict[str, float] = {"y": 1.0}
            @field_validator("gains")
            def check(cls, gains, info: ValidationInfo):
                for name in gains if info.context else ():
                    if f"{name}/odometry" not in info.context["channels"]["odometries"]:
                        raise ValueError(f"no robot '{name}'; there is r")
                return gains
        class Mixer(Component):
            stage = "think"
            config: Gains
            odometries: Each[Reads[odometry_t]] = channel("*/odometry")
        """,
    ),
    Broken(
        "it.yaml:2: it/a: its settings cannot be checked: KeyError: 'odometry'",
        """
        components:
          it/a: {use: strange:Mixer}
        --- strange.py
        from fwk import Component, Config, Each, Reads, channel
        from lcmtypes.robot import odometry_t
        from pydantic import ValidationInfo, field_validator
        class Gains(Config):
            gains: dict[str, float] = {}
            @field_validator("gains")
            def check(cls, gains, info: ValidationInfo):
                return gains if info.context is None else info.context["channels"]["odometry"]
        class Mixer(Component):
            stage = "think"
            config: Gains
            odometries: Each[Reads[odometry_t]] = channel("*/odometry")
        """,
    ),
    Broken(
        "it.yaml:1: it/a: the setting 'key' is missing; it has no default",
        "components: {it/a: {use: plan_parts:Keyed}}",
    ),
    Broken(
        """
        it.yaml:2: it/a: its settings cannot be checked: LookupError: no table
        it.yaml:3: it/b: the default of 'parts' does not fit: it should be greater than 3
        """,
        """
        components:
          it/a: {use: strange:Strict, config: {parts: 0}}
          it/b: {use: strange:Defaulted}
        --- strange.py
        from fwk import Component, Config, Field
        from pydantic import field_validator
        class Parts(Config):
            parts: int = 1
            @field_validator("parts")
            def check(cls, parts):
                raise LookupError('no table')
        class Strict(Component):
            stage = "think"
            config: Parts
        class Odd(Config):
            parts: int = Field(1, gt=3)
        class Defaulted(Component):
            stage = "think"
            config: Odd
        """,
    ),
    Broken(
        "it.yaml:2: it/a: 'high' is 4; it is below low, 5",
        """
        components:
          it/a: {use: strange:Ranged, config: {low: 5, high: 4}}
        --- strange.py
        from fwk import Component, Config, Field
        from pydantic import field_validator
        class Range(Config):
            low: int = 0
            high: int = 3
            @field_validator("high")
            def check(cls, high, info):
                if high < info.data["low"]:
                    raise ValueError(f"it is below low, {info.data['low']}")
                return high
        class Ranged(Component):
            stage = "think"
            config: Range
        """,
    ),
    Broken(
        "it.yaml:1: it/a: no setting 'gain'; there is log_level",
        "components: {it/a: {use: plan_parts:Odometer, config: {gain: 1}}}",
    ),
    Broken(
        "it.yaml:2: 'config.it/a' is [1, 2]; it should be a mapping with keys such as 'name: value'",
        """
        components: {it/a: {use: plan_parts:Keyed, config: {key: x}}}
        config: {it/a: [1, 2]}
        """,
    ),
    Broken(
        """
        it.yaml:3: it/a: no setting 'gain'; there are key, log_level
        it.yaml:5: no component 'it/c'; there are it/a, it/b
        it.yaml:6: no component 'itt'; did you mean 'it'?
        """,
        """
        components: {it/a: {use: plan_parts:Keyed, config: {key: x}}, it/b: {use: plan_parts:Odometer}}
        config:
          it/a: {gain: 1}
          "*/a": {key: y}
          it/c: {gain: 1}
          itt: {}
        """,
    ),
    Broken(
        """
        it.yaml:4: 'it' is not a component; did you mean 'it/a'?
        it.yaml:5: 'i*' is not a component; did you mean 'i*/b'?
        it.yaml:6: no component 'a'; did you mean 'it/a'?
        """,
        """
        components: {it/a: {use: plan_parts:Keyed, config: {key: x}}, it/b: {use: plan_parts:Odometer}}
        shared: {}
        config:
          it: {a: {key: y}}
          "i*": {b: {gain: 1}}
          a: {key: y}
        """,
    ),
    Broken(
        "it.yaml:2: no component 'shared'; write 'shared:' beside 'config:', not in it",
        """
        components: {it/a: {use: plan_parts:Odometer}}
        config: {shared: {gain: 1}}
        """,
    ),
    Broken(
        """
        --set: 'it/a.key' is not a PATH=VALUE; write for example cyan1/omni_ball.least_fit=0.5
        --set: no setting 'seeed'; did you mean 'seed'?
        --set: no setting 'it/a'; write NAME.SETTING=VALUE
        --set: '[1' is not a YAML value; write a number, true, false, text, [a, b] or {a: 1}
        --set: no component 'it/b'; there is it/a
        --set: it/a: 'key' is 5; it should be a valid string
        --set: it/a: no setting 'kye'; did you mean 'key'?
        """,
        "components: {it/a: {use: plan_parts:Keyed, config: {key: x}}}",
        {"sets": ["it/a.key", "seeed=1", "it/a=1", "it/b.key=2", "it/a.x=[1", "it/a.kye=1", "it/a.key=5"]},
    ),
)
def test_settings(folder: Path, broken: Broken) -> None:
    assert said(broken, folder) == expected(broken)


def test_setting_without_its_component_is_explained(folder: Path) -> None:
    keyed = Broken("", "components: {it/a: {use: plan_parts:Keyed, config: {key: x}}}", {"sets": ["key=y"]})
    (line,) = said(keyed, folder)
    assert line.startswith("--set: no setting 'key'; the run has period_s, ")
    assert line.endswith("; write shared.key or NAME.key for components")


@rows(
    Broken(
        "it.yaml:3: cyan1: no template 'bto'; did you mean 'bot'?",
        """
        templates: {bot: {a: {use: plan_parts:Odometer}}}
        robots:
          cyan1: {use: bto, config: {a: {x: 1}}}
          cyan2: {use: bot}
        """,
    ),
    Broken(
        "it.yaml:3: cyan1: robot 'cyan1' has no component 'odo'; did you mean 'odom'?",
        """
        templates: {bot: {odom: {use: plan_parts:Odometer}}}
        robots: {cyan1: {use: bot, config: {
          odo: {x: 1}}}}
        """,
    ),
    Broken(
        "it.yaml:2: cyan1/a (and 2 more): no module 'is_mine'; did you mean 'it_is_mine'?",
        """
        templates: {bot: {
          a: {use: is_mine}}}
        robots: {cyan1: {use: bot}, cyan2: {use: bot}, cyan3: {use: bot}}
        --- it_is_mine.py
        """,
    ),
    Broken(
        "it.yaml:2: it/a: no module 'gardener'; there is probe",
        """
        components:
          it/a: {use: gardener}
        --- probe.py
        --- test_gardener.py
        """,
    ),
    Broken(
        "it.yaml:2: cyan1/a: '{temm}' in '{temm}*/odometry' has no value; did you mean 'team'?",
        """
        templates: {bot: {
          a: {use: plan_parts:Watcher, channels: {odometries: "{temm}*/odometry"}}}}
        robots: {cyan1: {use: bot, values: {team: cyan}}}
        """,
    ),
    Broken(
        """
        it.yaml:2: there is a template 'bot' at part.yaml:1 already; rename one
        it.yaml:3: cyan1/a: there is a component of this name at part.yaml:2 already; rename one
        it.yaml:4: there is a robot 'cyan1' at part.yaml:3 already; rename one
        """,
        """
        include: part.yaml
        templates: {bot: {b: {use: plan_parts:Camera}}}
        components: {cyan1/a: {use: plan_parts:Odometer}}
        robots: {cyan1: {use: bot}}
        --- part.yaml
        templates: {bot: {b: {use: plan_parts:Camera}}}
        components: {cyan1/a: {use: plan_parts:Odometer}}
        robots: {cyan1: {use: bot}}
        """,
    ),
    Broken(
        """
        it.yaml:3: 'cyan 1' is not a valid name; use letters, digits, '_', '-' and '/', such as cyan1/ball
        it.yaml:5: cyan2/a: '{temm}' in '{temm}' has no value; there are name, namespace, number
        """,
        """
        templates: {bot: {b: {use: plan_parts:Odometer}}}
        robots:
          cyan 1: {use: bot}
        components:
          cyan2/a: {use: plan_parts:Odometer, needs: "{temm}"}
        """,
    ),
    Broken(
        "it.yaml:1: 'it/\ud800' is not a valid name; use letters, digits, '_', '-' and '/', such as cyan1/ball",
        """
        components: {"it/\\ud800": {use: plan_parts:Odometer}}
        """,
    ),
    Broken(
        r"it.yaml:1: 'x\ud800' has half of a letter, written as \ud800 to \udfff; write the whole letter",
        """
        components: {it/a: {use: strange:Named, config: {label: "x\\ud800"}}}
        --- strange.py
        from fwk import Component, Config
        class Name(Config):
            label: str = ""
        class Named(Component):
            stage = "think"
            config: Name
        """,
    ),
    Broken(
        "it.yaml:2: '1/a' is not a valid name; each part begins with a letter or '_', such as cyan1/ball",
        """
        components:
          1/a: {use: plan_parts:Odometer}
        """,
    ),
)
def test_templates_and_names(folder: Path, broken: Broken) -> None:
    assert said(broken, folder) == expected(broken)
