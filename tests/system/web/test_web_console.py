"""The console in a browser, on a real run of 105 components."""

import math
import re
from pathlib import Path

import cv2
import pytest
from playwright.sync_api import Page, expect

from fwk.control.address import supervisor_address
from fwk.control.client import Client
from tests.harness.browser import Console
from tests.harness.garden import ROWS, Garden, row
from tests.programs.garden_system import CROWD
from tools.docs.web_pictures import take

pytestmark = pytest.mark.system


def choose(page: Page, name: str) -> None:
    row(page, name).get_by_role("checkbox").click()


def test_system_page_shows_all_and_steers_by_clicks(garden: Garden) -> None:
    page = garden.open()
    expect(page.locator("[data-name=figures]")).to_contain_text(f"{CROWD + 5} components")
    expect(row(page, "a/mower")).to_contain_text("running")
    expect(row(page, "b/later")).to_contain_text("stopped")
    page.get_by_label("filter").fill(f"n{CROWD - 1:03}")
    expect(row(page, f"crowd/n{CROWD - 1:03}")).to_contain_text("think")
    page.get_by_label("filter").fill("a/")
    expect(page.locator(ROWS)).to_have_count(4)
    choose(page, "a/watcher")
    page.get_by_role("button", name="stop", exact=True).click()
    expect(row(page, "a/watcher")).to_contain_text("stopped")
    assert garden.state("a/watcher") == "stopped"
    page.get_by_role("button", name="start", exact=True).click()
    expect(row(page, "a/watcher")).to_contain_text("running")
    assert garden.state("a/watcher") == "running"


def test_pause_step_and_speed_act_on_the_run(garden: Garden) -> None:
    page, drawing = garden.open("/plots?run=garden"), f"/drawing?run={garden.name}"
    expect(page.locator("[data-name=state]")).to_have_text("running")
    page.get_by_role("button", name="pause or resume").click()
    expect(page.locator("[data-name=state]")).to_have_text("paused")
    before = garden.tick()
    page.get_by_role("button", name="one tick").click()
    expect(page.locator("[data-name=clock]")).to_contain_text(f"tick {before + 1} ")
    assert garden.tick() == before + 1
    expect(page.locator("[data-name=state]")).to_have_text("paused")
    page.get_by_role("button", name="pause or resume").press("Enter")
    expect(page.locator("[data-name=state]")).to_have_text("running")
    speed = page.get_by_role("combobox", name="speed")
    for option, how in (("max", ("fwk-period-ms", "1000")), ("x 2", ("fwk-glides", "1"))):
        speed.click()
        page.get_by_role("option", name=option).click()
        page.wait_for_function(f"async () => (await fetch({drawing!r})).headers.get({how[0]!r}) === {how[1]!r}")
    expect(page.locator("[data-name=clock]")).to_contain_text(re.compile(r"x (1\.[5-9]|2)"))


def test_details_of_a_component_set_its_log_level(garden: Garden) -> None:
    page = garden.open()
    page.get_by_label("filter").fill("a/mower")
    row(page, "a/mower").press("Enter")
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text(f"fwk debug a/mower --run {garden.name}")
    expect(dialog).to_contain_text("iterations, p50")
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    dialog.get_by_role("button", name="copy the line").click()
    assert page.evaluate("navigator.clipboard.readText()") == f"fwk debug a/mower --run {garden.name}"
    dialog.get_by_role("combobox", name="log level").click()
    page.get_by_role("option", name="error").click()
    settings = garden.open("/settings?run=garden&component=a/mower")
    expect(settings.get_by_label("a/mower.log_level")).to_have_value("error")
    dialog.get_by_role("combobox", name="log level").click()
    page.get_by_role("option", name="info").click()
    expect(page.get_by_text("changed", exact=True).last).to_be_visible()


def test_blackboard_shows_live_fields_and_sends_forms(garden: Garden) -> None:
    page = garden.open("/board?run=garden")
    page.get_by_label("filter").fill("a/place")
    expect(row(page, "a/place")).to_contain_text(re.compile(r"\d+\.\d"))
    page.get_by_text("a/place", exact=True).click()
    x_m = page.locator("[data-name=fields] tr").filter(has_text="x_m")
    first = x_m.inner_text()
    expect(x_m).not_to_have_text(first)
    page.get_by_label("filter").fill("a/image")
    row(page, "a/image").click()
    expect(page.locator("canvas")).to_have_attribute("data-picture", re.compile(r"\d+"))
    page.get_by_label("filter").fill("outside")
    page.get_by_text("a/visit@outside", exact=True).click()
    expect(page.locator("canvas")).to_have_count(0)
    page.get_by_label("x_m (double)").fill("far")
    page.get_by_role("button", name="send").click()
    expect(page.get_by_text("x_m: 'far' is not a number of type double")).to_be_visible()
    page.get_by_label("x_m (double)").fill("99")
    page.get_by_role("button", name="send").click()
    expect(page.get_by_text("a/visit: rejected: that is beyond the fence <img")).to_be_visible()
    page.get_by_label("x_m (double)").fill("1.5")
    page.get_by_label("stops_m (double, JSON)").fill("[1, 2.5]")
    page.get_by_label("note (string)").fill("by hand")
    page.get_by_role("button", name="send").click()
    expect(page.get_by_text("a/visit: done")).to_be_visible()
    page.get_by_label("filter").fill("wish")
    row(page, "garden/wish").press("Enter")
    text = page.get_by_label("text (string)")
    text.fill("rain")
    expect(text).to_have_value("rain")
    page.get_by_role("button", name="send").click()
    expect(page.get_by_text("garden/wish: sent")).to_be_visible()
    answers = ("garden/wish: sent", "a/visit: done", "a/visit: rejected: ", "x_m: 'far' is not ")
    expect(page.locator("[data-name=answers] > div")).to_contain_text(answers)  # they stay, the newest on top
    garden.run.until("visits (1.5, 0.0), by hand, [1.0, 2.5]")
    garden.run.until("wish 0: rain")


def test_a_form_stays_in_place_while_messages_come(garden: Garden) -> None:
    page, other = (garden.open("/board?run=garden&channel=garden/hint") for _ in range(2))
    other.get_by_label("text (string)").fill("sun")
    page.get_by_label("text (string)").fill("shade")
    expect(page.get_by_text("garden.wish_t: never written")).to_be_visible()
    page.get_by_role("button", name="send").hover()
    page.mouse.down()
    other.get_by_role("button", name="send").click()
    expect(page.locator("[data-name=fields]")).to_contain_text("sun")  # the first message: the fields take more room
    page.mouse.up()
    expect(page.get_by_text("garden/hint: sent")).to_be_visible()
    expect(page.locator("[data-name=fields]")).to_contain_text("shade")


def test_a_form_shows_the_newest_answers(garden: Garden) -> None:
    page = garden.open("/board?run=garden&channel=garden/wish")
    for _ in range(5):
        page.get_by_role("button", name="send").click()
    page.get_by_label("number (int32_t)").fill("many")
    page.get_by_role("button", name="send").click()
    mistake = "number: 'many' is not a number of type int32_t"
    expect(page.locator("[data-name=answers] > div")).to_have_text([mistake, *["garden/wish: sent"] * 4])


def test_devices_have_instruments_and_a_pad_drives(garden: Garden) -> None:
    page = garden.open("/devices?run=garden&channel=a/scan")
    expect(page.locator("[data-name=reading]")).to_contain_text("90 beams, 90 valid, nearest 3.00 m")
    expect(page.locator("[data-name=stick]")).to_have_count(0)
    expect(row(page, "a/image")).to_contain_text("Camera")
    row(page, "a/image").click()
    expect(page.locator("[data-name='canvas a/image'] canvas")).to_have_attribute("data-picture", re.compile(r"\d+"))
    row(page, "garden/stick").click()
    pad = page.locator("[data-name=stick]")
    pad.focus()
    page.keyboard.down("w")
    garden.run.until("stick [0.0, 1.0, 0.0]")
    expect(page.locator("[data-name=reading]")).to_contain_text("+0.00, +1.00, +0.00")
    page.keyboard.up("w")
    garden.run.until("stick [0.0, 0.0, 0.0]")
    box = pad.bounding_box()
    assert box
    page.mouse.move(box["x"] + box["width"] - 1, box["y"] + box["height"] / 2)
    page.mouse.down()
    garden.run.until("stick [0.9")
    page.close()  # a held pad whose page closes is released
    garden.run.until_count("stick [0.0, 0.0, 0.0]", 2)


def test_settings_change_live_and_say_why_not(garden: Garden) -> None:
    page = garden.open("/settings?run=garden")
    page.get_by_text("a", exact=True).locator("xpath=preceding-sibling::i | ../preceding-sibling::i").first.click()
    page.get_by_text("mower", exact=True).click()
    radius = page.get_by_label("a/mower.radius_m")
    expect(radius).to_have_value("2.0")
    expect(page.get_by_text("float, more than 0.0, at most 5.0, ")).to_be_visible()
    radius.fill("50")
    radius.press("Enter")
    expect(page.locator("[data-name='mistake a/mower.radius_m']")).to_contain_text("less than or equal to 5")
    radius.fill("3.5")
    radius.press("Enter")
    expect(page.get_by_text(re.compile(r"changed here, since tick \d+"))).to_be_visible()
    with Client(supervisor_address(garden.ports.bus)) as run:
        (setting,) = run.ask("settings", names=["a/mower.radius_m"])["settings"]
    assert (setting["value"], setting["origin"].partition(",")[0]) == (3.5, "fwk web")
    page.get_by_role("button", name="difference to the launch file").click()
    expect(page.get_by_text("in the launch file: 2.0")).to_be_visible()
    expect(page.get_by_label("a/mower.motto")).to_have_count(0)


def test_the_log_follows_and_filters(garden: Garden) -> None:
    page = garden.open("/log?run=garden")
    lines = page.locator(".fwk-lines > div")
    expect(lines.filter(has_text="grass").first).to_be_visible()
    page.get_by_label("note for the log").fill("look here")
    page.get_by_label("note for the log").press("Enter")
    expect(lines.filter(has_text="look here")).to_be_visible()
    page.get_by_label("text (regular").fill("look (here")
    expect(page.locator("[data-name=mistake]")).to_contain_text("text: ")
    page.get_by_label("text (regular").fill("look h")
    expect(lines).to_have_count(1)
    page.get_by_label("text (regular").fill("")
    expect(
        lines.filter(has_text="grass").first
    ).to_be_visible()  # each change of a filter empties the list for a moment
    page.get_by_label("component or pattern").fill("a/*")
    expect(lines.filter(has_text="look here")).to_have_count(0)
    first = lines.filter(has_text="grass").first
    tick = first.get_attribute("data-tick")
    first.get_by_role("link", name=f"tick {tick} of the recording").press("Enter")  # lines move on below a mouse
    expect(page.locator("[data-name=tick]")).to_have_text(f"tick {tick}")
    expect(page.locator("[data-name=log] > div").last).to_contain_text("grass")


def test_runs_are_seen_side_by_side(garden: Garden) -> None:
    page = garden.open("/runs?run=garden")
    card = page.locator(f"[data-name='run {garden.name}']")
    expect(card).to_contain_text(f"garden, {CROWD + 5} components")
    expect(card).to_contain_text(re.compile(r"running\s*tick \d+"))
    page.get_by_role("combobox", name="launch file").click()
    page.get_by_role("option", name="garden.yaml").click()
    card.get_by_role("link", name=garden.name).click()
    expect(row(page, "a/mower")).to_contain_text("running")


def test_own_pages_are_offered_where_they_fit(garden: Garden) -> None:
    page = garden.open()
    expect(page.get_by_role("link", name="Elsewhere")).to_have_count(0)
    page.get_by_role("link", name="Gate").click()
    page.get_by_role("button", name="home").click()
    expect(page.get_by_text("called home")).to_be_visible()


def test_two_browsers_see_the_same_and_a_reader_cannot_steer(garden: Garden) -> None:
    reader = Console(garden.folder, "--read-only")
    try:
        page = garden.browser.open(f"{reader.url}/?run={garden.name}", own=True)
        expect(page.locator("[data-name=read-only]")).to_be_visible()
        expect(page.get_by_role("button", name="pause or resume")).to_have_count(0)
        expect(page.get_by_role("button", name="stop", exact=True)).to_have_count(0)
        other = garden.open()
        expect(other.locator("[data-name=state]")).to_have_text("running")
        other.get_by_role("button", name="pause or resume").click()
        for each in (page, other):
            expect(each.locator("[data-name=state]")).to_have_text("paused")
        other.get_by_role("button", name="pause or resume").click()
        expect(page.locator("[data-name=state]")).to_have_text("running")
    finally:
        assert reader.end() == 0


def test_a_phone_shows_every_page_without_overflow(garden: Garden) -> None:
    page = garden.open(width_px=390, height_px=800, scheme="dark")
    for path in ("/", "/view", "/board", "/settings", "/log"):
        page.goto(f"{garden.console.url}{path}?run={garden.name}")
        expect(page.locator("[data-name=state]")).to_have_text("running")
        assert page.evaluate("document.documentElement.scrollWidth") <= 390, path
        expect(page.locator("body")).to_have_class(re.compile("body--dark"))
    page.get_by_role("button", name="dark or light").click()
    expect(page.locator("body")).to_have_class(re.compile("body--light"))
    page.reload()
    expect(page.locator("body")).to_have_class(re.compile("body--light"))


def test_nothing_that_a_component_prints_is_markup(garden: Garden) -> None:
    pages = ("/", "/log", "/board?run=garden&channel=a/place", "/settings?run=garden&component=a/mower", "/view")
    page = garden.open()
    for path in pages:
        page.goto(f"{garden.console.url}{path.replace('run=garden', f'run={garden.name}')}")
        expect(page.locator("[data-name=state]")).to_have_text("running")
        if path != "/":
            expect(page.get_by_text("<script>document.title").first).to_be_visible()
        assert "broken" not in page.title()
        assert page.locator("img[src=x]").count() == 0


def test_the_graph_shows_states_and_rates(garden: Garden) -> None:
    page = garden.open("/graph?run=garden")
    graph = page.get_by_label("graph of the components")
    expect(graph.locator("g.running")).to_have_count(CROWD + 4)
    expect(graph.locator("g.stopped")).to_have_text("b/later")
    mower = graph.locator("g").filter(has=page.get_by_text("a/mower", exact=True))
    mower.press("Enter")  # only what it exchanges messages with
    expect(page.get_by_label("components, such as")).to_have_value("a/mower")
    expect(graph.locator("g").filter(has_text="crowd")).to_have_count(0)
    expect(graph.locator(".rate").first).to_have_text(re.compile(r"place (9\.\d|1\d\.\d) Hz"))
    expect(graph.locator("path > title").first).to_have_text(re.compile(r"a/mower to .*: a/place [1-9]\d?\.\d Hz"))


def test_plots_draw_any_numeric_fields_together(garden: Garden) -> None:
    page = garden.open("/plots?run=garden")
    fields = page.get_by_label("fields, such as")
    fields.fill("a/place")
    expect(page.locator("[data-name=mistake]")).to_contain_text("'a/place' is not CHANNEL.FIELD")
    fields.fill("a/place.x_m, a/place.covariance_m2[0][1]")
    expect(page.locator("[data-name=mistake]")).to_have_text("")
    expect(page.locator("canvas")).to_be_visible()


def test_pictures_of_the_documentation_can_be_taken(garden: Garden, tmp_path: Path) -> None:
    made = take(garden.browser.browser, garden.console.url, garden.name, tmp_path, settled_ms=0.0)
    assert sorted(made) == sorted(tmp_path.iterdir())
    found = {path.stem: cv2.imread(str(path)) for path in made}
    sizes = {name: picture.shape[:2] for name, picture in found.items() if picture is not None}
    assert sizes["web-view"] == (800, 1280)
    assert sizes["web-phone"] == (760, 390)


def test_recordings_are_shown_tick_by_tick(garden: Garden) -> None:
    garden.run.until_true(lambda: garden.tick() > 60, "the file of the recording has tick 30")
    page = garden.open("/recordings?run=garden")
    page.get_by_role("cell", name=re.compile("-garden")).first.click()
    expect(page.locator("[data-name=tick]")).to_have_text("tick 1")
    page.get_by_role("button", name="one tick on").click()
    expect(page.locator("[data-name=tick]")).to_have_text("tick 2")
    expect(page.locator("[data-name=headline]")).to_contain_text("mower <img")
    page.get_by_role("button", name="play").click()
    expect(page.locator("[data-name=tick]")).to_have_text(re.compile(r"tick \d\d"))
    page.get_by_role("button", name="play").click()
    name = garden.run.run_dir.name
    page.goto(f"{garden.console.url}/recordings?log={name}&tick=29")
    page.get_by_role("button", name="one tick on").click()
    expect(page.locator("[data-name=tick]")).to_have_text("tick 30")
    page.get_by_role("link", name="Blackboard").click()
    expect(page.locator("[data-name=tick]")).to_have_text("tick 30")
    row(page, "a/place").click()
    x_m = page.locator("[data-name=fields] tr").filter(has_text="x_m")
    expect(x_m).to_contain_text(f"{2 * math.cos(3.0):.5f}"[:6])
    page.get_by_role("button", name="one tick back").click()
    expect(x_m).to_contain_text(f"{2 * math.cos(2.9):.5f}"[:6])
    page.get_by_role("link", name="Log", exact=True).click()
    lines = page.locator("[data-name=lines] > div")
    expect(lines.filter(has_text="grass").first).to_be_visible()
    assert max(int(each.get_attribute("data-tick") or 0) for each in lines.all()) <= 29
    page.get_by_role("link", name="Devices").click()
    row(page, "a/scan").click()
    expect(page.locator("[data-name=reading]")).to_contain_text("90 beams")
    expect(page.get_by_role("button", name="pause or resume")).to_have_count(0)
    graph = page.request.get(f"{garden.console.url}/graph.svg?log={name}&tick=29&around=a/*")
    assert "a/mower to a/watcher: a/place 10.0 Hz" in graph.text()
    for tick, radius_m in ((1, 2.0), (30, 2.0)):
        drawing = page.request.get(f"{garden.console.url}/drawing?log={name}&tick={tick}").json()
        circle = next(shape for shape in drawing["shapes"] if shape["k"] == "circle")
        assert circle["x"] == pytest.approx(radius_m * math.cos(0.1 * tick), abs=0.001)
    assert page.request.get(f"{garden.console.url}/drawing?log=../../etc&tick=1").status == 404


def test_an_open_page_outlives_the_run(garden: Garden) -> None:
    page = garden.open()
    expect(page.locator("[data-name=state]")).to_have_text("running")
    garden.run.signal(2)
    assert garden.run.wait() == 0
    expect(page.locator("[data-name=banner]")).to_contain_text(f"'{garden.name}' does not run")
    garden.launch()
    expect(page.locator("[data-name=state]")).to_have_text("running")
    expect(page.locator("[data-name=banner]")).to_be_hidden()
    expect(row(page, "a/mower")).to_contain_text("running")
