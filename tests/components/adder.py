"""A program that speaks JSON lines: adds up the readings that it gets; fails in tick FAILS_AT of its first life."""

import json
import os
import sys
from pathlib import Path

FAILS_AT, MARK = int(sys.argv[1]), Path("failed_once")

total = 0.0
for line in sys.stdin:
    asked = json.loads(line)
    if asked["tick"] == FAILS_AT and not MARK.exists():
        MARK.touch()
        os._exit(3)
    total += sum(each["x"] for each in asked["inputs"].get("step", ()))
    print(json.dumps({} if asked["stage"] == "init" else {"sum": {"x": total}}), flush=True)
