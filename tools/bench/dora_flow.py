"""Writes the dataflow of a shape for dora: every process a node, and a ring of inputs through the supervisor."""

import json
from pathlib import Path
from typing import Any

from tools.bench.environments import DORA
from tools.bench.shape import Shape


def commands(shape_file: str) -> list[list[str]]:
    """Returns one command: dora's own process is the daemon and starts the nodes."""
    shape = Shape.read(shape_file)
    path = Path(shape.folder, "dataflow.yml")
    path.write_text(json.dumps(dataflow(shape, shape_file)))  # JSON is YAML
    return [[str(DORA.folder / "bin" / "dora"), "run", str(path)]]


def dataflow(shape: Shape, shape_file: str) -> dict[str, Any]:
    """Returns the dataflow as dora's descriptor."""
    nodes: list[dict[str, Any]] = [
        {
            "id": "supervisor",
            "path": DORA.python,
            "args": f"-m tools.bench.supervise dora {shape_file}",
            "inputs": {f"done{index}": f"c{index}/done" for index in range(shape.components)},
            "outputs": [f"tick{stage}" for stage in range(shape.stages)],
        }
    ]
    for index in range(shape.components):
        inputs = {f"data{source}": f"c{source}/data" for source in shape.sources(index)}
        nodes.append(
            {
                "id": f"c{index}",
                "path": DORA.python,
                "args": f"-m tools.bench.component dora {shape_file} {index}",
                "inputs": {"tick": f"supervisor/tick{shape.stage(index)}", **inputs},
                "outputs": ["data", "done"],
            }
        )
    return {"nodes": nodes}
