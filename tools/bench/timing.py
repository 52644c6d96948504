"""The benchmark's clock and waits; peers run under interpreters in which fwk's own clock cannot be imported."""

import time


def now_us() -> int:
    """Returns wall time in µs that never goes back."""
    return time.monotonic_ns() // 1000


def sleep_s(duration_s: float) -> None:
    """Waits."""
    time.sleep(duration_s)  # noqa: TID251 - no component waits here, see above
