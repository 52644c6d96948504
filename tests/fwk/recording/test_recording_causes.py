"""Causes of differences that the syntax of a module shows, and those that it must not claim."""

from pathlib import Path

import pytest

from fwk.recording.causes import causes

TIME, RANDOM, THREADS = "reads the machine's clock", "draws unseeded random numbers", "starts threads or processes"


def found(folder: Path, text: str, **others: str) -> list[str]:
    """Returns the causes in a module `own`, and in others that it may import, as `file:line: reason`."""
    files = {}
    for name, content in {"own": text, **others}.items():
        files[name] = str(folder / f"{name}.py")
        Path(files[name]).write_text(content)
    return [str(cause).removeprefix(f"{folder}/") for cause in causes("own", files)]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("import time\nx = time.monotonic()", TIME),
        ("from time import time_ns as now\nx = now()", TIME),
        ("import datetime as dt\nx = dt.datetime.now()", TIME),
        ("import random\nx = random.random()", RANDOM),
        ("from random import Random\nx = Random()", RANDOM),
        ("import numpy as np\nx = np.random.rand(3)", RANDOM),
        ("import numpy as np\nx = np.random.default_rng()", RANDOM),
        ("import threading\nthreading.Thread(target=print)", THREADS),
        ("from concurrent.futures import ThreadPoolExecutor\nThreadPoolExecutor()", THREADS),
        ("\nfor x in {1, 2}: print(x)", "depends on the order of a set"),
        ("names = set('ab')\nx = [name for name in names]", "depends on the order of a set"),
        ("self.x = set() | {1}\nprint(list(self.x))", "depends on the order of a set"),
        ("\nx = ''.join({'a', 'b'})", "depends on the order of a set"),
        ("\nx = {1, 2}.pop()", "depends on the order of a set"),
        ("\nx = [*{1, 2}.union({3})]", "depends on the order of a set"),
        ("import os\nx = os.environ['HOME']", "reads environment variables"),
        ("import os\nx = os.getenv('HOME')", "reads environment variables"),
        ("\nx = hash('a')", "depends on the process"),
        ("import os\nx = os.listdir()", "depends on the order of files in a folder"),
    ],
)
def test_each_kind_of_cause_is_found_with_its_line(tmp_path: Path, text: str, reason: str) -> None:
    (cause,) = found(tmp_path, text)
    assert cause.startswith(f"own.py:2: {reason}")


@pytest.mark.parametrize(
    "text",
    [
        "import random\nx = random.Random(3).random()",
        "import numpy as np\nx = np.random.default_rng(3).normal()",
        "for x in sorted({1, 2}): print(x)",
        "names = {1}\nnames = [1]\nfor x in names: print(x)",
        "self.clock.time()",
        "names = [1]\nx = names.pop(), ', '.join(['a'])",
        "names = {'a': 1}\nx = names.pop('a')",
        "import time\ntime.sleep(1)",
        "this is not Python",
    ],
)
def test_what_makes_no_difference_is_not_named(tmp_path: Path, text: str) -> None:
    assert found(tmp_path, text) == []


def test_imported_modules_of_the_application_count(tmp_path: Path) -> None:
    helper = "import time\nimport own\ndef now(): return time.time()"
    assert found(tmp_path, "import helper, json", helper=helper) == [f"helper.py:3: {TIME}"]
    assert found(tmp_path, "import json", helper=helper) == []
