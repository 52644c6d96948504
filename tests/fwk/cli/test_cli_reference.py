"""docs/commands.md agrees with the help of the commands."""

from pathlib import Path

from fwk.cli.commands import MODULES
from fwk.cli.reference import index, reference

PAGE = Path(__file__).parents[3] / "docs" / "commands.md"


def test_the_page_agrees_with_the_commands() -> None:
    assert PAGE.read_text() == reference(), "run: make docs"


def test_every_command_has_a_section_with_its_options() -> None:
    page = reference()
    for name in MODULES:
        assert f"## `fwk {name} " in page
    assert "| `--hosting process\\|robot\\|single` | one process a component" in page
    assert "| `--set PATH=VALUE` |" in page


def test_choices_are_the_words_to_type() -> None:
    assert "| `--form text\\|mermaid\\|svg` |" in reference()
    assert '"choices": ["text", "mermaid", "svg"]' in index()
