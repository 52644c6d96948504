"""A separate network for each run, so that runs do not disturb each other; with packet loss on request."""

import shutil
import subprocess

# A process namespace too: when the driver ends, the kernel ends all descendants, including daemons.
_UNSHARE = ("unshare", "--net", "--pid", "--fork", "--kill-child", "--mount-proc")
_SET_UP = (
    "ip link set lo up",
    "ip link set lo multicast on",
    "ip route add 224.0.0.0/4 dev lo",
    "mount -t tmpfs bench /dev/shm",  # leftovers of killed processes go with the namespace
)


class NoNamespaceError(Exception):
    """This machine does not permit network namespaces; the text gives the reason."""


def command() -> list[str]:
    """Returns the words before a command that runs it in a new network namespace.

    Raises:
        NoNamespaceError: neither as this user nor in a user namespace.
    """
    for words in ([*_UNSHARE], [*_UNSHARE, "--map-root-user"]):
        if (
            shutil.which(words[0])
            and subprocess.run([*words, "true"], capture_output=True, check=False).returncode == 0
        ):
            return words
    raise NoNamespaceError("unshare --net --pid is not allowed here; run as root, or allow user namespaces")


def set_up(loss: float) -> None:
    """Sets up the new namespace: loopback with multicast, an empty /dev/shm, and loss of a share of all IP packets.

    Raises:
        NoNamespaceError: ip or iptables is missing or refuses.
    """
    commands = [words.split() for words in _SET_UP]
    if loss:
        drop = f"-A INPUT -m statistic --mode random --probability {loss} -j DROP"
        commands.append(["iptables", *drop.split()])
    for words in commands:
        try:
            result = subprocess.run(words, capture_output=True, text=True, check=False)
        except OSError as error:
            raise NoNamespaceError(f"{' '.join(words)}: {error}") from error
        if result.returncode:
            raise NoNamespaceError(f"{' '.join(words)}: {result.stderr.strip()}")
