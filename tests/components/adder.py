"""A program that speaks JSON lines: adds up the readings that it gets; fails in tick FAILS_AT of its first life.

It offers its sum as a service, and asks another component for one, if it has the ports.
"""

import json
import os
import sys
from pathlib import Path
from typing import Any

FAILS_AT, MARK = int(sys.argv[1]), Path("failed_once")
HAS_SERVICES = len(sys.argv) > 2

total = 0.0
for line in sys.stdin:
    asked = json.loads(line)
    if asked["tick"] == FAILS_AT and not MARK.exists():
        MARK.touch()
        os._exit(3)
    total += sum(each["x"] for each in asked["inputs"].get("step", ()))
    answer: dict[str, Any] = {} if asked["stage"] == "init" else {"sum": {"x": total}}
    for each in asked["inputs"].get("ask", ()):
        x = each["request"]["x"]
        told = {"reply": {"x": total + x}} if x >= 0 else {"state": "rejected", "reason": "negative"}
        answer.setdefault("ask", []).append({"id": each["id"], **told})
    for each in asked["inputs"].get("other", ()):
        print(
            f"call {each['id']}: {each['state']}, {each.get('reply', {}).get('x')}, {each['reason']}", file=sys.stderr
        )
    if HAS_SERVICES and asked["tick"] % 5 == 0 and asked["stage"] == "act":
        answer["other"] = {"x": 10 - asked["tick"]}
    print(json.dumps(answer), flush=True)
