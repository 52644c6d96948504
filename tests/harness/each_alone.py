"""Replays each component of the recording `log.lcm` of the current folder alone.

Prints as JSON how many messages of each component were compared, and which of them differed.
"""

import json
import sys
from pathlib import Path

from fwk.recording.replay.recording import Recording
from fwk.recording.replay.replay import Replay

LOG = Path("log.lcm")


def main() -> None:
    """Replays the components one after another."""
    sys.path.append(".")
    found = {}
    for component in Recording(LOG).plan.components:
        alone = Replay(Recording(LOG), [component.name])
        alone.run()
        found[component.name] = (alone.compared, [str(each) for each in alone.differences])
    print(json.dumps(found))


if __name__ == "__main__":
    main()
