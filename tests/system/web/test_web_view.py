"""The console's view in a browser: what is drawn moves smoothly, is dragged and zoomed."""

import re

import pytest
from playwright.sync_api import expect

from tests.harness.garden import Garden
from tests.system.web.glides import AFTER, BEFORE, CENTRE, GLIDES, HALF_WAY, PICTURE_TIMES, WAIT_FOR_GLIDES

pytestmark = pytest.mark.system


def test_a_view_draws_smoothly_and_lets_shapes_be_dragged(garden: Garden) -> None:
    garden.run.until_true(lambda: garden.tick() > 40, "the beginning of the recording is as other tests expect it")
    page = garden.open("/view?run=garden")
    canvas = page.locator("canvas")
    expect(page.locator("[data-name=headline]")).to_contain_text("mower <img")
    expect(canvas).to_have_attribute("data-frames", re.compile(r"[1-9]\d"))
    colours = "c => { const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let n = 0; "
    colours += "for (let i = 0; i < d.length; i += 4) n += d[i] > 200 && d[i + 1] < 80; return n; }"
    assert canvas.evaluate(colours) > 200
    page.evaluate(WAIT_FOR_GLIDES, 5)
    page.get_by_role("checkbox", name="mower").click()  # hides the layer
    page.wait_for_function(f"() => ({colours})(document.querySelector('canvas')) === 0")
    page.get_by_role("checkbox", name="mower").click()
    page.get_by_role("button", name="pause or resume").click()
    expect(page.locator("[data-name=state]")).to_have_text("paused")
    place = garden.place()
    box = canvas.bounding_box()
    assert box
    scale = min(box["width"], box["height"]) / 10.0
    page.wait_for_function(f"""() => {{
        const [x, y] = ({CENTRE})(document.querySelector('canvas')).map((each) => each / {scale});
        return Math.hypot(x - {place[0]}, y - {place[1]}) < 0.02;
    }}""")  # exact while paused
    x_px = box["x"] + box["width"] / 2 + place[0] * scale
    y_px = box["y"] + box["height"] / 2 - place[1] * scale
    page.mouse.click(x_px, y_px)
    image = page.locator("[data-name='canvas a/image'] canvas")
    expect(image).to_have_attribute("data-picture", re.compile(r"\d+"))
    expect(image).to_be_in_viewport(ratio=0.9)  # beside the drawing, which shows all of it again
    box = canvas.first.bounding_box()
    assert box
    scale = float(canvas.first.get_attribute("data-scale") or 0)
    assert scale == pytest.approx(min(box["width"], box["height"]) / 10.0, rel=0.01)
    x_px = box["x"] + box["width"] / 2
    y_px = box["y"] + box["height"] / 2
    page.mouse.move(x_px + place[0] * scale, y_px - place[1] * scale)
    page.mouse.down()
    page.mouse.move(x_px + 3 * scale, y_px - scale, steps=3)
    page.mouse.up()
    page.get_by_role("button", name="pause or resume").click()
    garden.run.until_true(lambda: "dragged mower" in garden.run.text, "the mower was dragged")
    visited = re.search(r"visits \(([-\d.]+), ([-\d.]+)\), dragged mower", garden.run.text)
    assert visited
    assert [float(each) for each in visited.groups()] == pytest.approx((3.0, 1.0), abs=0.1)


def test_a_view_is_zoomed_by_keys_and_wheel(garden: Garden) -> None:
    page = garden.open("/view?run=garden")
    canvas = page.locator("canvas")
    expect(canvas).to_have_attribute("data-frames", re.compile(r"[1-9]"))
    assert page.evaluate(GLIDES, [BEFORE, AFTER]) == HALF_WAY
    assert page.evaluate(PICTURE_TIMES) == [45, 240, 45, 45, 500]
    scale = float(canvas.get_attribute("data-scale") or 0)

    def wait_for_scale(wanted: float) -> None:
        page.wait_for_function(f"() => Math.abs(document.querySelector('canvas').dataset.scale - {wanted}) < 0.03")

    canvas.focus()
    page.keyboard.press("+")
    wait_for_scale(1.2 * scale)
    page.keyboard.press("0")
    wait_for_scale(scale)
    canvas.hover()
    page.mouse.wheel(0, -100)
    wait_for_scale(1.15 * scale)
    page.goto(f"{garden.console.url}/view?run={garden.name}&view=1")  # of everything, without fixed bounds
    page.wait_for_function(  # it begins near the mower, whose circle is 4 m high
        "() => { const c = document.querySelector('canvas'); return c && c.dataset.scale < c.clientHeight / 4; }"
    )
