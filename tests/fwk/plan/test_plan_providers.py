"""Providers of aspects: found in the plan, or refused with the names of both sides."""

from collections.abc import Callable
from pathlib import Path

from fwk.model.plan import Plan
from tests.fwk.plan.plan_mistakes import Broken, expected, rows, said

Load = Callable[..., Plan]


def test_a_user_needs_its_provider_and_reads_its_channels(load: Load) -> None:
    plan = load(
        "components:\n"
        "  a/guide: {use: plan_parts:Guide}\n"
        "  b/guide: {use: plan_parts:Guide, providers: {way: a/farer}}\n"
        "  c/guide: {use: plan_parts:Guide}\n"
        "  a/farer: {use: plan_parts:Wayfarer, channels: {odometry: path}}\n"
        "  b/farer: {use: plan_parts:Wayfarer}\n"
        "  c/one: {use: plan_parts:Wayfarer, channels: {odometry: d/x}}\n"
    )
    guides = [each for each in plan.components if each.class_name == "Guide"]
    assert [each.channels for each in guides] == [
        {"way.odometry": ("a/path",)},
        {"way.odometry": ("a/path",)},
        {"way.odometry": ("d/x",)},
    ]
    assert [each.needs for each in guides] == [(3,), (3,), (5,)]


def test_guide_takes_the_provider_that_its_template_names(load: Load) -> None:
    plan = load(
        "templates: {bot: {guide: {use: plan_parts:Guide, providers: {way: '{namespace}/two'}},\n"
        "  one: {use: plan_parts:Wayfarer}, two: {use: plan_parts:Wayfarer, channels: {odometry: other}}}}\n"
        "robots: {a: {use: bot}, b: {use: bot}}\n"
    )
    assert [each.channels["way.odometry"] for each in plan.components if each.class_name == "Guide"] == [
        ("a/other",),
        ("b/other",),
    ]


@rows(
    Broken(
        "it.yaml:2: a/guide: no component provides Way, which a/guide asks for as 'way'; add a component whose class "
        "has 'provides = Way'",
        """
        components:
          a/guide: {use: plan_parts:Guide}
          a/one: {use: plan_parts:Odometer}
        """,
    ),
    Broken(
        "it.yaml:2: a/guide: 2 components provide Way, which a/guide asks for as 'way': b/farer and c/farer; keep one, "
        "or set 'providers: {way: b/farer}'",
        """
        components:
          a/guide: {use: plan_parts:Guide}
          b/farer: {use: plan_parts:Wayfarer}
          c/farer: {use: plan_parts:Wayfarer}
        """,
    ),
    Broken(
        """
        it.yaml:2: a/guide: 'b/frer' does not provide Way, which it asks for as 'way'; did you mean 'b/farer'?
        it.yaml:3: b/guide: 'b/one' does not provide Way, which it asks for as 'way'; there is b/farer
        it.yaml:4: c/guide: it declares no aspect 'wya' that a component provides; did you mean 'way'?
        """,
        """
        components:
          a/guide: {use: plan_parts:Guide, providers: {way: b/frer}}
          b/guide: {use: plan_parts:Guide, providers: {way: one}}
          c/guide: {use: plan_parts:Guide, providers: {wya: b/farer}}
          b/farer: {use: plan_parts:Wayfarer}
          b/one: {use: plan_parts:Odometer, channels: {odometry: two}}
        """,
    ),
    Broken(
        "it.yaml:2: a/leader: components need each other in a cycle: a/leader -> a/led -> a/leader; "
        "let one do without what another provides",
        """
        components:
          a/leader: {use: plan_parts:Leader}
          a/led: {use: plan_parts:Led}
        """,
    ),
    Broken(
        "it.yaml:1: a/farer: no module 'procs.localization.frame_tre'; did you mean 'procs.localization.frame_tree'?",
        "components: {a/farer: {use: procs.localization.frame_tre}, a/guide: {use: plan_parts:Guide}}",
    ),
    Broken(
        "--without: a/guide: it cannot do without a/farer, which is left out; leave out both or none",
        "components: {a/guide: {use: plan_parts:Guide}, a/farer: {use: plan_parts:Wayfarer}}",
        {"without": ["a/farer"]},
    ),
    Broken(
        "it.yaml:2: a/guide: it starts with the run and needs 'a/farer', which does not; "
        "set 'start: false' here too, or remove it there",
        """
        components:
          a/guide: {use: plan_parts:Guide}
          a/farer: {use: plan_parts:Wayfarer, start: false}
        """,
    ),
)
def test_refused_combinations(folder: Path, broken: Broken) -> None:
    assert said(broken, folder) == expected(broken)
