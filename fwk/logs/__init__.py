"""Targets of log lines: text and JSON files, syslog, components; and reading the files again."""
