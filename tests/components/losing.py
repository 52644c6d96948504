"""A player whose messages get lost and that stops before its readers can fetch them."""

import os
import signal
from typing import Any

from fwk.host.outputs import Outputs


def lose_and_stand_still() -> None:
    publish = Outputs.publish

    def publish_nothing(self: Outputs, written: Any) -> Any:
        sender: Any = self._sender
        send = sender.publish

        def send_last(*done: Any) -> None:
            send(*done)
            sender.publish = send
            os.kill(os.getpid(), signal.SIGSTOP)

        sender.publish = lambda *_: None
        marks = publish(self, written)
        sender.publish = send_last
        Outputs.publish = publish  # type: ignore[method-assign]
        return marks

    Outputs.publish = publish_nothing  # type: ignore[method-assign]


MORE = {"lose": lose_and_stand_still}
