"""Generator: makes projects, components, message types and launch files, and edits the classes of components."""
