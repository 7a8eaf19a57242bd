"""The page of a scene: loads without a complaint, moves, shows what the FMU told."""

import math

import pytest
from conftest import PHONE, SCREEN

FRAMES = [0, 137, 400, 1001]
MICROMETRE = 1e-3  # mm


@pytest.mark.parametrize("device", [SCREEN, PHONE], ids=["screen", "phone"])
@pytest.mark.parametrize("scene", ["wornpin", "seed", "hold"])
def test_it_loads_without_a_complaint_and_without_a_network(opened, scene, device):
    page = opened(scene, device)
    page.page.wait_for_timeout(300)
    assert page.complaints == []
    assert [url for url in page.requests if not url.startswith(("file:", "data:", "blob:"))] == []
    assert page.page.locator("h1").text_content() == scene


def test_the_play_button_moves_the_slider_and_stops_it(fresh):
    page = fresh("wornpin")
    start = page.slider()
    page.page.click("#play")
    page.page.wait_for_timeout(400)
    assert page.page.locator("#play").text_content() == "Pause"
    assert abs(page.slider()[0] - start[0]) > 1.0
    page.page.click("#play")
    stopped = page.slider()
    page.page.wait_for_timeout(200)
    assert page.slider() == stopped
    assert page.page.locator("#play").text_content() == "Play"


@pytest.mark.parametrize("scene", ["wornpin", "seed", "hold"])
def test_to_scale_the_drawn_loop_closes_where_the_slider_is(opened, scene):
    """The drawing closes the loop from crank and eccentricities; the FMU told where the slider is."""
    page = opened(scene)
    page.set("exaggeration", 0)
    outputs = page.film["outputs"]
    for frame in [frame for frame in FRAMES if frame < len(page.film["time"])]:
        page.frame(frame)
        x, y, tilt = page.slider()
        wanted = [1e3 * outputs["slider.x"][frame], 1e3 * outputs["slider.y"][frame]]
        # A bent rod's ends are nearer to each other than its length, by about 8/3 of deflection squared over length.
        shortened = 1e3 * 8 / 3 * outputs["rod.deflection"][frame] ** 2 / page.film["parameters"]["rod.length"]
        assert abs(x - wanted[0]) < 0.1 * MICROMETRE + 3 * shortened, (frame, x, wanted)
        assert abs(y - wanted[1]) < 0.1 * MICROMETRE
        assert abs(math.radians(tilt) - outputs["slider.angle"][frame]) < 1e-6


def test_a_larger_clearance_is_a_larger_error_in_the_drawing(opened):
    page = opened("wornpin")
    outputs, parameters = page.film["outputs"], page.film["parameters"]
    for frame in FRAMES:
        page.frame(frame)
        places = []
        for share in [0, 1]:
            page.set("exaggeration", share)
            places.append(page.slider()[0])
        factor = float(page.page.locator("#exaggerated").text_content().replace("×", ""))
        assert factor > 5
        # Without play; the rod leans by eccentricity over length, which is small of second order.
        r, l, angle = parameters["crank.length"], parameters["rod.length"], outputs["crank.angle"][frame]
        ideal = 1e3 * (r * math.cos(angle) + math.sqrt(l**2 - (r * math.sin(angle)) ** 2))
        small, large = (place - ideal for place in places)
        assert abs(large - factor * small) < 0.25, (frame, small, large, factor)


def test_arrows_are_as_long_as_forces(opened):
    page = opened("wornpin")
    page.set("force", 0.3)
    outputs = page.film["outputs"]
    lengths, forces = [], []
    for frame in range(0, 1200, 40):
        page.frame(frame)
        path = page.page.locator("#arrowA").get_attribute("d")
        ends = [tuple(map(float, end.split())) for end in path.replace("M", "L").split("L")[1:3]]
        force = math.hypot(outputs["joint.A.force.x"][frame], outputs["joint.A.force.y"][frame])
        if len(ends) == 2:
            lengths.append(math.dist(*ends))
            forces.append(force)
    scales = [length / force for length, force in zip(lengths, forces)]
    short = [scale for scale, length in zip(scales, lengths) if length < 60]
    assert len(short) > 15
    assert max(short) / min(short) < 1.001


def test_figures_are_there_with_their_curves(opened):
    page = opened("wornpin").page
    sections = page.locator("section h2").all_text_contents()
    assert sections == [
        "Mechanism",
        "What the scene calls for",
        "Motion and forces",
        "Journals in their bearings",
        "In the long run",
        "Accuracy of the slider",
        "Cost of accuracy",
    ]
    points = page.evaluate(
        "[...document.querySelectorAll('figure.plot')].map(f => f.data.reduce((n, trace) => n + trace.x.length, 0))"
    )
    # Slider, its error, four forces; one journal; portrait, two paths, section, impacts, spectrum, exponent; the price.
    assert len(points) == 3 + 1 + 4 + 1 + 7 + 1
    assert all(count >= 10 for count in points)
    drawn = page.locator("figure.plot .main-svg").count()
    assert drawn >= len(points)
    titles = page.evaluate("[...document.querySelectorAll('figure.plot')].map(f => f.layout.xaxis.title.text)")
    assert "slider velocity [m/s]" in titles and "journal of C along the guide, once a turn [µm]" in titles
    assert page.locator("text=Chaotic; exponent").count() == 1
    assert page.locator("#accuracy-of-the-slider tr").count() == 17 + 6 + 6


def test_a_curve_zooms_and_the_others_over_turns_with_it(fresh):
    page = fresh("wornpin").page
    figure = page.locator('figure[data-over="turns"]').first
    figure.scroll_into_view_if_needed()
    box = figure.locator(".nsewdrag").first.bounding_box()
    middle = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + 0.3 * box["width"], middle)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.5 * box["width"], middle, steps=5)
    page.mouse.up()
    page.wait_for_timeout(500)
    ranges = page.evaluate(
        "[...document.querySelectorAll('figure[data-over=\"turns\"]')].map(f => f.layout.xaxis.range)"
    )
    widths = [high - low for low, high in ranges]
    assert widths[0] == pytest.approx(0.2 * 2.1, rel=0.15)
    assert ranges.count(ranges[0]) == 8


def test_a_click_on_a_curve_shows_the_mechanism_there(fresh):
    opened = fresh("wornpin")
    page = opened.page
    figure = page.locator('figure[data-over="turns"]').first
    figure.scroll_into_view_if_needed()
    box = figure.locator(".nsewdrag").first.bounding_box()
    x = page.evaluate("document.querySelector('figure[data-over=turns]').data[1].x")
    y = page.evaluate("document.querySelector('figure[data-over=turns]').data[1].y")
    number = len(x) // 3
    place = page.evaluate(
        """([x, y]) => {
            const { xaxis, yaxis } = document.querySelector("figure[data-over=turns]")._fullLayout;
            return [xaxis.l2p(x), yaxis.l2p(y)];
        }""",
        [x[number], y[number]],
    )
    page.mouse.move(box["x"] + place[0] - 3, box["y"] + place[1])
    page.mouse.move(box["x"] + place[0], box["y"] + place[1], steps=3)
    page.wait_for_timeout(200)
    page.mouse.click(box["x"] + place[0], box["y"] + place[1])
    page.wait_for_timeout(200)
    told = float(page.locator("#where").text_content().split()[0])
    assert told == pytest.approx(x[number], abs=0.02)


@pytest.mark.parametrize("scene", ["wornpin", "seed", "hold"])
def test_it_reads_well_on_a_phone(opened, scene):
    page = opened(scene, PHONE).page
    width = PHONE["viewport"]["width"]
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    for box in [element.bounding_box() for element in page.locator("button, .controls label, figure, p, h2").all()]:
        assert box["x"] >= 0 and box["x"] + box["width"] <= width + 0.5, box
    sizes = page.evaluate(
        "[...document.querySelectorAll('p, td, th, label, output, button')].map(e => parseFloat(getComputedStyle(e).fontSize))"
    )
    assert min(sizes) >= 14
    button = page.locator("#play").bounding_box()
    assert button["height"] >= 44
    assert page.locator("#drawing").bounding_box()["width"] >= 0.85 * width
    before = page.locator("#slider").get_attribute("transform")
    page.tap("#play")
    page.wait_for_timeout(300)
    assert scene == "hold" or page.locator("#slider").get_attribute("transform") != before


def test_what_cannot_be_shown_says_why(opened):
    page = opened("hold").page
    assert page.locator(".missing").all_text_contents() == [
        "Not shown: crank.speed_start = 0 rad/s: turns cannot be counted if the crank does not turn."
    ]


def test_the_list_of_effects_is_the_scene_s(opened):
    page = opened("seed").page
    rows = page.locator("#what-the-scene-calls-for tr").all()
    told = {row.locator("th").first.text_content(): row.locator("td").text_content() for row in rows[1:]}
    assert told["main bearing A"] == "ideal"
    assert told["slider pin C"].startswith("clearance 100.0 µm;")
    assert told["elastic rod"].startswith("a uniform beam's: 3 bending, 1 axial modes")
    assert told["gravity"] == "–" and told["energy audit"] == "–"
