"""A plain module that knows nothing of fwk and logs with Python's `logging`."""

import logging

log = logging.getLogger(__name__)


def think(tick: int) -> None:
    log.debug("nothing much")
    log.warning("tick %d is odd", tick)
    log.info("broken %d", "text")
    try:
        print(1 / 0)
    except ZeroDivisionError:
        log.exception("cannot divide")
