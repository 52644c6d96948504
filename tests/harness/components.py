"""Components of the tests: real modules in `tests/components`, which a test copies into its user's folder."""

from pathlib import Path

FOLDER = Path(__file__).parents[1] / "components"


def source(name: str) -> str:
    """Returns the text of a file of `tests/components`, such as `player.py` or `lcmtypes/play.lcm`."""
    return (FOLDER / name).read_text()


def sources(*names: str) -> dict[str, str]:
    """Returns files of `tests/components` by name, as `write_files` takes them."""
    return {name: source(name) for name in names}
