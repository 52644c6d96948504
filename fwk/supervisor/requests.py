"""What the components of a host ask for or tell in a done, as its text is read once for everybody whom it concerns."""

from collections.abc import Mapping
from typing import Any

Wishes = Mapping[str, Any]
"""By aspect, mostly by the name of the component in that."""
