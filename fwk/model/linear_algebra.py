"""Threads of the linear-algebra libraries: one in each process, so that results do not depend on the machine."""

import os

THREAD_LIMITS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


def limit_threads() -> None:
    """Limits linear algebra to one thread in this process and its children; a limit that is set already stays.

    A pool of threads in every process of a run would slow all of them down, and the order in which its threads end
    would show in the last bits of results. The libraries read these variables when numpy is imported for the first
    time, so a program calls this function before that.
    """
    for variable in THREAD_LIMITS:
        os.environ.setdefault(variable, "1")
