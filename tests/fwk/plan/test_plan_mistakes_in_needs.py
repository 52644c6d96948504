"""Mistakes of a launch file about what components need, and about time."""

from pathlib import Path

from tests.fwk.plan.plan_mistakes import Broken, expected, rows, said


@rows(
    Broken(
        "it.yaml:3: it/b: it needs 'it/aa', which does not exist; did you mean 'it/a'?",
        """
        components:
          it/a: {use: plan_parts:Odometer}
          it/b: {use: plan_parts:Watcher, needs: [aa]}
        """,
    ),
    Broken(
        "it.yaml:3: it/b: components need each other in a cycle: it/b -> it/c -> it/d -> it/b; leave one 'needs' out",
        """
        components:
          it/a: {use: plan_parts:Odometer, needs: it/b}
          it/b: {use: plan_parts:Watcher, needs: [c]}
          it/c: {use: plan_parts:Watcher, needs: [it/d]}
          it/d: {use: plan_parts:Watcher, needs: b}
        """,
    ),
    Broken(
        "it.yaml:3: it/camera: components need each other in a cycle: it/camera -> it/eye -> it/camera; "
        "leave one 'needs' out",
        """
        components:
          it/eye: {use: plan_parts:Eye}
          it/camera: {use: plan_parts:Camera, needs: eye}
        """,
    ),
    Broken(
        "it.yaml:1: it/a: components need each other in a cycle: it/a -> it/a; leave one 'needs' out",
        "components: {it/a: {use: plan_parts:Odometer, needs: a}}",
    ),
    Broken(
        "it.yaml:2: it/eye: it starts with the run and needs 'it/camera', which does not; "
        "set 'start: false' here too, or remove it there",
        """
        components:
          it/eye: {use: plan_parts:Eye}
          it/camera: {use: plan_parts:Camera, start: false}
        """,
    ),
    Broken(
        "it.yaml:2: it/one and it/two share a process and only one starts with the run; set 'start' alike for both",
        """
        hosts:
          both: it/*
        components:
          it/one: {use: plan_parts:Odometer}
          it/two: {use: plan_parts:Watcher, start: false}
        """,
    ),
    Broken(
        "it.yaml:4: it/b: processes need each other in a cycle: left -> right -> left "
        "(it/b needs it/c; it/d needs it/a); group the components differently",
        """
        hosts: {left: [it/a, it/b], right: [it/c, it/d]}
        components:
          it/a: {use: plan_parts:Odometer}
          it/b: {use: plan_parts:Watcher, needs: c}
          it/c: {use: plan_parts:Watcher}
          it/d: {use: plan_parts:Watcher, needs: a}
        """,
    ),
    Broken(
        """
        --only: it/eye: it cannot do without it/camera, which is left out; leave out both or none
        """,
        "components: {it/eye: {use: plan_parts:Eye}, it/camera: {use: plan_parts:Camera}}",
        {"only": ["it/eye"]},
    ),
    Broken(
        """
        --without: it/eye: it cannot do without it/camera, which is left out; leave out both or none
        """,
        "components: {it/eye: {use: plan_parts:Eye}, it/camera: {use: plan_parts:Camera}}",
        {"without": ["*/camera"]},
    ),
    Broken(
        "it.yaml:3: a/eye: 'mirror.height_m' is 0.5 in a/eye, but 0.75 in a/camera; both use the frames of a/image: "
        "set them alike, for example under 'shared:'",
        """
        components:
          a/camera: {use: plan_parts:MirroredCamera, config: {gain: 2}}
          a/eye: {use: plan_parts:MirroredEye, config: {mirror: {height_m: 0.5}}}
          b/camera: {use: plan_parts:MirroredCamera, config: {mirror: {height_m: 0.5}}}
          b/eye: {use: plan_parts:MirroredEye, config: {mirror: {height_m: 0.5}}}
          c/eye: {use: plan_parts:Eye, channels: {image: b/image}}
        """,
    ),
    Broken(
        "it.yaml:2: a/camera: 'mirror.size_px' is [400, 400] in a/eye, but [640, 480] in a/camera; both use the "
        "frames of a/image: set them alike, for example under 'shared:'",
        """
        components:
          a/camera: {use: plan_parts:MirroredCamera, config: {mirror: {size_px: [640, 480]}}}
          a/eye: {use: plan_parts:MirroredEye}
        """,
    ),
    Broken(
        "it.yaml:3: b/sun: two time sources: a/sun (it.yaml:2) and b/sun; keep one",
        """
        components:
          a/sun: {use: plan_parts:Sun}
          b/sun: {use: plan_parts:Sun}
        """,
    ),
    Broken(
        "it.yaml:3: a/sun: two time sources: the wall clock (clock: wall) and a/sun; "
        "keep one, or set 'clock: simulated'",
        """
        clock: wall
        components:
          a/sun: {use: plan_parts:Sun}
        """,
    ),
    Broken(
        "it.yaml:1: a/sun: two time sources: the wall clock (clock: wall) and a/sun; "
        "keep one, or set 'clock: simulated'",
        "components: {a/sun: {use: plan_parts:Sun}}",
        {"sets": ["clock=wall"]},
    ),
)
def test_needs_and_time(folder: Path, broken: Broken) -> None:
    assert said(broken, folder) == expected(broken)
