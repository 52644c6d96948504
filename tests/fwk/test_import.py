"""Cost and contents of `import fwk`, and its independence of the application."""

import re
import subprocess
import sys
from pathlib import Path

import fwk

ROOT = Path(fwk.__file__).parent
HEAVY = ("cv2", "pymunk", "scipy", "filterpy")
CPU_S = 0.5
"""Far above the 0.03 s that it takes, far below the 1.5 s of one of the heavy libraries."""


def in_fresh_interpreter(program: str) -> str:
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, timeout=60)
    return done.stdout.strip()


def test_import_changes_no_environment_and_no_threads() -> None:
    program = f"""
import os, sys, threading, time
before, began = dict(os.environ), time.process_time()
import fwk
seconds = time.process_time() - began
print(dict(os.environ) == before, threading.active_count(), "numpy" in sys.modules, seconds < {CPU_S})
"""
    assert in_fresh_interpreter(program) == "True 1 False True"


def test_everything_for_authors_needs_no_heavy_library() -> None:
    loaded = in_fresh_interpreter(f"""
import sys, os, threading
before = dict(os.environ)
from fwk import *
import fwk.component.declaration, fwk.host.host, fwk.supervisor.supervisor
print([name for name in {HEAVY} if name in sys.modules], dict(os.environ) == before, threading.active_count())
""")
    assert loaded == "[] True 1"


def test_every_exported_name_exists() -> None:
    assert sorted(fwk.__all__) == sorted(name for names in fwk._MODULES.values() for name in names)
    for name in fwk.__all__:
        assert getattr(fwk, name) is not None
    assert set(fwk.__all__) <= set(dir(fwk))


def test_an_unknown_name_is_reported() -> None:
    program = "import fwk\ntry: fwk.Reader\nexcept AttributeError as error: print(error)"
    assert in_fresh_interpreter(program) == "module 'fwk' has no attribute 'Reader'"


def test_commands_limit_linear_algebra_before_numpy() -> None:
    program = "import sys, os, fwk.cli; print('numpy' in sys.modules, os.environ['OPENBLAS_NUM_THREADS'])"
    assert in_fresh_interpreter(program) == "False 1"


def test_framework_names_nothing_of_the_soccer_robots() -> None:
    word = re.compile(r"\bsoccer\b|\bworld/|\bprocs\b", re.I)
    assert [
        f"{file.relative_to(ROOT)}:{number}: {line.strip()}"
        for file in sorted(ROOT.rglob("*.py"))
        for number, line in enumerate(file.read_text().splitlines(), 1)
        if word.search(line)
    ] == []
