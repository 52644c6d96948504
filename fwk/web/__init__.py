"""The web console: a browser sees and steers running systems. Exports the classes for views and pages of projects."""

from fwk.web.scene import Newest, Scene
from fwk.web.view import OpenPage, Page, RunAccess, View

__all__ = ["Newest", "OpenPage", "Page", "RunAccess", "Scene", "View"]
