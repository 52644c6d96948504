"""The documentation site: generated reference pages and the hooks that add them to mkdocs."""
