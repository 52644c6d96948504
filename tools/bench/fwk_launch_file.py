"""Writes the launch file of a shape for fwk."""

import json
from pathlib import Path
from typing import Any

from tools.bench.shape import Shape

_MODULE = "tools.bench.fwk_component"
_GROUP = 10
_PERIOD_S = 0.01


def write(shape: Shape, shape_file: str, grouped: bool = False, wall_period_s: float = 0.0) -> str:
    """Writes `launch.yaml` into the shape's folder; returns its path.

    `grouped`: ten components a process; `wall_period_s`: real time with that period
    and a probe as first component, 0: lockstep.
    """
    components = {}
    for index in range(shape.components):
        sources = shape.sources(index)
        relay = "Probe" if wall_period_s and index == 0 else f"Relay{len(sources)}"
        components[f"bench/c{index}"] = {
            "use": f"{_MODULE}:{relay}",
            "stage": f"s{shape.stage(index)}",
            "config": {"index": index, "shape_file": shape_file},
            "channels": {
                "out": f"bench/d{index}",
                **{f"in{number}": f"bench/d{source}" for number, source in enumerate(sources)},
            },
        }
    file: dict[str, Any] = {
        "name": "bench",
        "period_s": wall_period_s or _PERIOD_S,
        "clock": "wall" if wall_period_s else "simulated",
        "speed": "max" if not wall_period_s else 1.0,
        "stages": [f"s{stage}" for stage in range(shape.stages)],
        "components": components,
    }
    if grouped:
        file["hosts"] = {
            f"host{first // _GROUP}": [
                f"bench/c{index}" for index in range(first, min(first + _GROUP, shape.components))
            ]
            for first in range(0, shape.components, _GROUP)
        }
    path = Path(shape.folder, "launch.yaml")
    path.write_text(json.dumps(file))  # JSON is YAML
    return str(path)
