"""Commands that make projects and edit their components."""
