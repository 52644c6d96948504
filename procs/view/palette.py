"""Colours of the teams, as blue, green, red."""

from procs.model.robot import CYAN, MAGENTA
from procs.view.canvas import Colour

TEAM_COLOURS: dict[str, Colour] = {CYAN: (214, 176, 0), MAGENTA: (170, 40, 214)}
UNKNOWN_TEAM: Colour = (120, 120, 120)
