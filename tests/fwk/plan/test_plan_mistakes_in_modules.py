"""Mistakes in modules and classes of a launch file that the check reports."""

import subprocess
import sys
from pathlib import Path

from tests.fwk.plan.plan_mistakes import Broken, expected, rows, said


@rows(
    Broken(
        "it.yaml:1: it/a: no module 'trakcer'; did you mean 'tracker'?",
        """
        components: {it/a: {use: trakcer}}
        --- tracker.py
        """,
    ),
    Broken(
        "it.yaml:1: it/a: no module 'mine.trakcer'; did you mean 'mine.tracker'?",
        """
        components: {it/a: {use: mine.trakcer}}
        --- mine/tracker.py
        """,
    ),
    Broken(
        "it.yaml:1: it/a: no module 'mine.tracker.inner'; there are mine.tracker, mine.tracker_inner",
        """
        components: {it/a: {use: mine.tracker.inner}}
        --- mine/tracker.py
        --- mine/tracker_inner.py
        """,
    ),
    Broken(
        "it.yaml:1: it/a: no module 'procs.quux'; there are procs.garden.watering, procs.weeding",
        """
        components: {it/a: {use: procs.quux}}
        --- procs/garden/watering.py
        --- procs/weeding.py
        """,
    ),
    Broken(
        "it.yaml:1: it/a: no module 'procs.vision.omni_bal'; did you mean 'procs.vision.omni_ball'?",
        "components: {it/a: {use: procs.vision.omni_bal}}",
    ),
    Broken(
        "it.yaml:1: it/a: cannot import 'arrays': a setting cannot be of type numpy.ndarray; use numbers, text, bool, "
        "a list or tuple of them, an Enum, or a Config (arrays.py:3)",
        """
        components: {it/a: {use: arrays}}
        --- arrays.py
        from fwk import Config
        import numpy as np
        class Arrays(Config):
            mine: np.ndarray
        """,
    ),
    Broken(
        "it.yaml:1: it/a: 'procs/omni_ball.py' is not a module; write it as in Python: drivers.wheels, or "
        "drivers.wheels:Wheels",
        "components: {it/a: {use: procs/omni_ball.py}}",
    ),
    Broken(
        "it.yaml:1: it/a: module 'without' defines no component; derive a class from fwk.Component",
        """
        components: {it/a: {use: without}}
        --- without.py
        from fwk import Component
        """,
    ),
    Broken(
        "it.yaml:1: it/a: module 'several' defines several components; name one: several:One or several:Two",
        """
        components: {it/a: {use: several}}
        --- several.py
        from fwk import Component
        class One(Component):
            stage = "think"
        class Two(One): ...
        """,
    ),
    Broken(
        "it.yaml:1: it/a: module 'plan_parts' has no component 'Odmeter'; did you mean 'Odometer'?",
        "components: {it/a: {use: plan_parts:Odmeter}}",
    ),
    Broken(
        "it.yaml:1: it/a: plan_parts:NotAComponent is not a component; derive it from fwk.Component",
        "components: {it/a: {use: plan_parts:NotAComponent}}",
    ),
    Broken(
        'it.yaml:1: it/a: plan_parts.Stageless: no stage; write for example: stage = "think"',
        "components: {it/a: {use: plan_parts:Stageless}}",
    ),
    Broken(
        """
        it.yaml:2: it/a: restless.Both: both a stage and a rate; keep 'stage', or 'rate_hz' to be continuous
        it.yaml:3: it/b: restless.Wrong: rate_hz is 'often'; it should be a number from 0 to 10000
        it.yaml:4: it/c: restless.Looks.image: a continuous component cannot use frames, because their ring does not \
wait for it; give it a stage, or let a component with a stage read the frames
        it.yaml:5: it/d: restless.Times.sun: a continuous component cannot be a time source; give it a stage
        it.yaml:6: it/e: it is continuous and takes part in no stage; leave 'stage' out
        it.yaml:7: it/f: it takes part in stages; leave 'rate_hz' out, or give its class a rate_hz instead of a stage
        it.yaml:8: it/g: it is continuous and takes part in no tick; leave 'every' out
        it.yaml:9: it/h: a time source iterates in each tick; leave 'every' out
        it.yaml:10: it/i: offset is '-1'; it should be a whole number from 0 on, of at most 6 digits, \
such as 1 or '{number}'
        it.yaml:11: it/j: offset is 'one'; it should be a whole number from 0 on, of at most 6 digits, \
such as 1 or '{number}'
        it.yaml:12: it/k: it is continuous and takes part in no tick; leave 'offset' out
        it.yaml:13: it/l: offset is '1.0'; it should be a whole number from 0 on, of at most 6 digits, \
such as 1 or '{number}'
        """,
        """
        components:
          it/a: {use: restless:Both}
          it/b: {use: restless:Wrong}
          it/c: {use: restless:Looks}
          it/d: {use: restless:Times}
          it/e: {use: restless:Right, stage: think}
          it/f: {use: restless:Staged, rate_hz: 5}
          it/g: {use: restless:Right, every: 2}
          it/h: {use: restless:Sun, every: 2}
          it/i: {use: restless:Staged, every: 2, offset: -1}
          it/j: {use: restless:Staged, offset: one}
          it/k: {use: restless:Right, offset: 2}
          it/l: {use: restless:Staged, every: 2, offset: 1.0}
        --- restless.py
        from fwk import Component, Image, TimeSource
        class Both(Component):
            stage = "think"
            rate_hz = 5
        class Wrong(Component):
            rate_hz = "often"
        class Looks(Component):
            rate_hz = 5
            image: Image
        class Times(Component):
            rate_hz = 5
            sun: TimeSource
        class Sun(Component):
            stage = "think"
            sun: TimeSource
        class Right(Component):
            rate_hz = 0
        class Staged(Component):
            stage = "think"
        """,
    ),
)
def test_modules_and_classes(folder: Path, broken: Broken) -> None:
    assert said(broken, folder) == expected(broken)


@rows(
    Broken(
        "it.yaml:1: it/a: cannot import 'typing_error': invalid syntax (typing_error.py:3)",
        """
        components: {it/a: {use: typing_error}}
        --- typing_error.py

        x = 1
        if x ==
        """,
    ),
    Broken(
        "it.yaml:1: it/a: cannot import 'outer': NameError: name 'undefined' is not defined (inner.py:1)",
        """
        components: {it/a: {use: outer}}
        --- outer.py
        import inner
        --- inner.py
        def f(): return undefined
        f()
        """,
    ),
    Broken(
        "it.yaml:1: it/a: cannot import 'hungry': ModuleNotFoundError: No module named 'pancakes' (hungry.py:1)",
        """
        components: {it/a: {use: hungry}}
        --- hungry.py
        import pancakes
        """,
    ),
    Broken(
        "it.yaml:1: it/a: cannot import 'typed': no types 'lcmtypes.flowers'; they come from lcmtypes/flowers.lcm "
        "(typed.py:1)",
        """
        components: {it/a: {use: typed}}
        --- typed.py
        from lcmtypes.flowers import rose_t
        """,
    ),
    Broken(
        "it.yaml:1: it/a: cannot import 'leaving': SystemExit: 3 (leaving.py:1)",
        """
        components: {it/a: {use: leaving}}
        --- leaving.py
        raise SystemExit(3)
        """,
    ),
    Broken(
        "it.yaml:1: it/a: cannot import 'decoding': ValueError: '0.1' is no channel (decoding.py:3)",
        """
        components: {it/a: {use: decoding}}
        --- decoding.py
        import json
        def hook(text):
            raise ValueError(f"{text!r} is no channel")
        json.loads("0.1", parse_float=hook)
        """,
    ),
)
def test_imports(folder: Path, broken: Broken) -> None:
    assert said(broken, folder) == expected(broken)


def test_an_init_file_that_hides_installed_components_is_named(folder: Path) -> None:
    (folder / "procs").mkdir()
    (folder / "procs" / "__init__.py").touch()
    (folder / "it.yaml").write_text("components: {it/a: {use: procs.view.pictures}}")
    program = "from fwk.plan.load import load_plan; load_plan('it.yaml')"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False, timeout=250)
    assert done.stderr.splitlines()[-1].endswith(
        "it.yaml:1: it/a: no module 'procs.view.pictures'; procs/__init__.py hides the installed package 'procs'; "
        "remove this file to use modules of both"
    )
