"""Pictures of the documentation are drawn from recordings."""

import xml.etree.ElementTree as ET

from fwk.display.view import View
from tests.fwk.cli.cli_runs import MATCH, packet, plan, status
from tools.docs.pictures import display


def test_the_display_is_a_picture_without_other_files() -> None:
    view = View(plan())
    view.take(packet("fwk/status", status(MATCH, 77)))
    picture = display(view, "fwk-launch match.yaml")
    text = "".join(ET.fromstring(picture).itertext()).replace("\xa0", " ")
    assert "tick 77" in text
    assert "q quit" in text
    assert "url(http" not in picture
