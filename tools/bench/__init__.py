"""Measures a full tick of fwk beside other ways to do the same work: python -m tools.bench."""

import sys
from pathlib import Path

# The benchmark's own message type joins the namespace package lcmtypes, as a user's types do.
sys.path.append(str(Path(__file__).parent / "messages"))
