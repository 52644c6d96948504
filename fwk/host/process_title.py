"""Titles by which ps, top and debuggers tell processes apart."""

import os

_SHORT = 15
"""Bytes that the kernel keeps of a process's short name, which `top` shows."""
_KEEP_ENVIRONMENT = "SPT_NOENV"
"""Setting of setproctitle that leaves alone the memory from which other processes read this one's environment."""


def name_process(plan: str, role: str) -> None:
    """Names this process: `fwk: PLAN ROLE` in full, the end of the role in short."""
    os.environ[_KEEP_ENVIRONMENT] = "1"
    from setproctitle import setproctitle, setthreadtitle

    setproctitle(f"fwk: {plan} {role}")
    setthreadtitle(role.encode()[-_SHORT:].decode(errors="ignore"))
    del os.environ[_KEEP_ENVIRONMENT]
