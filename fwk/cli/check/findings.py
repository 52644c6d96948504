"""The result of one check of `fwk doctor`."""

from dataclasses import dataclass
from enum import StrEnum


class Severity(StrEnum):
    """Severity of a finding."""

    OK = "ok"
    WARNING = "warning"
    """Runs work, but something beside them does not."""
    BAD = "bad"
    """Runs do not work."""


@dataclass(frozen=True)
class Finding:
    """The result of one check."""

    level: Severity
    subject: str
    text: str
    advice: str = ""
    """Command that helps."""
