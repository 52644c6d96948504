"""Standard output and error of host processes, line by line into the log."""

import os
from collections.abc import Callable

from fwk.supervisor.mailbox import Mailbox

_LINE_MAX = 4096


class Captured:
    """Reads one process's stream and gives whole lines to `take`."""

    def __init__(self, descriptor: int, mailbox: Mailbox, take: Callable[[str], None]) -> None:
        self._descriptor = descriptor
        self._mailbox = mailbox
        self._take = take
        self._rest = b""
        os.set_blocking(descriptor, False)
        mailbox.watch(descriptor, self._read)

    def _read(self) -> None:
        try:
            data = os.read(self._descriptor, 65536)
        except BlockingIOError:
            return
        lines = (self._rest + data).split(b"\n")
        self._rest = lines.pop()
        if len(self._rest) > _LINE_MAX or not data:
            lines.append(self._rest)
            self._rest = b""
        for line in lines:
            if line:
                self._take(line[:_LINE_MAX].decode(errors="replace"))
        if not data:
            self._mailbox.unwatch(self._descriptor)
            os.close(self._descriptor)
