"""Generates the message classes before the tests import them."""

from pathlib import Path

from fwk.testing import use_types_of

use_types_of(Path(__file__).parents[1])
