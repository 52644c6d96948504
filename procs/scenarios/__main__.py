"""`python -m procs.scenarios`."""

from fwk.program import imported, run_program


def _program() -> int:
    from procs.scenarios.command import main

    imported()
    return main()


if __name__ == "__main__":
    run_program(_program)
