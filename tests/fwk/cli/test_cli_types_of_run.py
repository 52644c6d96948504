"""Tools for logs know the types of a run, wherever they are called, and those of its time."""

import json
import shutil
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

import pytest

from fwk.lcm.messages import Message
from fwk.lcm.typegen import generate
from fwk.model.plan_document import document_of
from fwk.testing.plans import plan_of
from lcmtypes.core import plan_t, protocol_t
from tests.fwk.recording.recording_made import write
from tests.harness.runs import fwk


def apple(project: Path, members: str) -> Any:
    """Writes a type of a project, and returns its class without making the project's types available."""
    (project / "lcmtypes").mkdir(parents=True, exist_ok=True)
    (project / "lcmtypes" / "orchard.lcm").write_text(f"package orchard;\nstruct apple_t {{ {members} }}\n")
    (package,) = generate(project / "lcmtypes")
    spec = spec_from_file_location("apple_of_this_test", package / "apple_t.py")
    assert spec
    assert spec.loader
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.apple_t


def recorded(run: Path, project: Path, message: Message) -> Path:
    """Writes the recording of a run of the project, with a copy of its types beside it."""
    shutil.copytree(project / "lcmtypes", run / "lcmtypes", ignore=shutil.ignore_patterns("orchard"))
    plan = plan_t()
    document = document_of(plan_of({}, folders=(str(project),), outside={"tree/apple": "core.log_t"}))
    document["channels"][0]["type_name"] = "orchard.apple_t"
    plan.version, plan.json = protocol_t.VERSION, json.dumps(document)
    return write(run / "log.lcm", [("fwk/plan", plan.encode(), 0), ("tree/apple", bytes(message.encode()), 1)])


@pytest.mark.parametrize("later", ["unchanged", "changed", "removed"])
def test_messages_are_decoded_by_the_types_of_the_run(tmp_path: Path, later: str) -> None:
    project, away = tmp_path / "project", tmp_path / "away"
    away.mkdir()
    run = recorded(tmp_path / "run", project, apple(project, "double size_m;")(size_m=0.08)).parent
    if later == "changed":
        apple(project, "double size_m; double mass_kg;")
    elif later == "removed":
        shutil.rmtree(project)
    fwk(away, "export", str(run), "--channels", "tree/apple", "--out", "apples.jsonl")
    _, row = map(json.loads, (away / "apples.jsonl").read_text().splitlines())  # the plan stands first
    assert (row["channel"], row["message"]) == ("tree/apple", {"size_m": 0.08})
