"""The version of the framework."""


def version() -> str:
    """Returns name and version of the framework."""
    from importlib.metadata import PackageNotFoundError
    from importlib.metadata import version as installed

    try:
        return f"fwk {installed('fwk')}"
    except PackageNotFoundError:
        return "fwk (not installed as a package)"
