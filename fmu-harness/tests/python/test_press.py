"""Stack-up finds the clearances that were put in; the slide tilts as mirrors and levers tell; 27 placements."""

import itertools
import math

import numpy
import pandas
import pytest

from slidercrank import plan, plots, study
from slidercrank.placements import placements
from slidercrank.press import Scene, at_bottom_dead_centre, bottom_dead_centre, curve, parallelism, readings, stack_up, unloaded
from slidercrank.source import home

from conftest import fmu

LOAD = -100e3
"""[N] On the press, from below."""


def played(a, b, c):
    """The scene with clearances [m], 0 of an ideal joint."""
    sizes = {"A": a, "B": b, "C": c}
    models = {f"joint.{joint}.model": 2 if size else 1 for joint, size in sizes.items()}
    return models | {f"joint.{joint}.clearance": size for joint, size in sizes.items() if size}


@pytest.mark.parametrize("sizes", [(40e-6, 40e-6, 25e-6), (10e-6, 100e-6, 300e-6), (0, 5e-6, 1e-3), (0, 0, 50e-6)])
@pytest.mark.parametrize("scene", ["press", "wornpin"])
def test_stack_up_finds_what_was_put_in(scene, sizes):
    found = stack_up(fmu(scene), settings=played(*sizes))
    assert list(found.index) == ["A", "B", "C", "total"]
    assert found["put in"].to_list() == [*(2 * size for size in sizes), pytest.approx(2 * sum(sizes), rel=1e-15)]
    # Hertz's contacts are powers of their load, so that the curve has no error but the rests': 1e-5 of the clearances.
    assert (found["difference"].abs() <= 1e-5 * 2 * sum(sizes)).all(), found
    assert (found["difference"] == found["found"] - found["put in"]).all()
    assert (found["error"] <= 1e-5 * 2 * sum(sizes)).all(), found


def test_without_the_curve_a_contact_that_gives_way_would_count_as_clearance():
    scene = Scene.of(fmu("press"), {})
    pull, push = (readings(fmu("press"), scene, scene.levels, sign) for sign in (1.0, -1.0))
    travel = (pull["travel"] - push["travel"]).to_numpy()
    # The lowest load is read twice, as it rises and as it falls, and leaves micrometres.
    assert travel[0] - 210e-6 > 10e-6 and abs(travel[0] - travel[-1]) < 1e-9
    assert travel.argmax() == len(travel) // 2


@pytest.mark.parametrize("settings", [
    {f"joint.{joint}.elasticity": 2 for joint in "ABC"},  # Liu: conformal, no power of the load
    {"gravity.angle": -math.pi / 2},  # weights across the guide: journals are not in line
    {"guide.offset": 0.002},  # nor is the rod with the guide
    {"guide.offset": 0.02},
    {"guide.offset": 0.2},
])
def test_what_is_no_power_or_not_in_line_is_within_the_error_that_is_told(settings):
    found = stack_up(fmu("press"), settings=settings)
    assert (found["difference"].abs() <= found["error"] + 1e-11).all(), found
    assert found.loc["total", "error"] < 5e-6


@pytest.mark.parametrize("settings, same, height", [
    ({"slider.centre.y": 0.05}, {"guide.offset": -0.05}, -0.05),
    ({"slider.centre.y": 0.05, "guide.offset": 0.05}, {}, 0.0),
])
def test_the_dead_centre_is_that_of_the_pin_wherever_the_guide_lies(settings, same, height):
    assert Scene.of(fmu("press"), settings).angle == pytest.approx(math.asin(height / 0.515), rel=1e-12)
    # The same mechanism, whose slide is named from another point.
    found, expected = (stack_up(fmu("press"), settings=told) for told in (settings, same))
    assert numpy.allclose(found, expected, rtol=0.0, atol=1e-11)
    strokes = parallelism(fmu("ideal"), [0.0], load=0.0, turns=1.0, settings={"drive.mode": 2, **settings})
    stroke, bottom = strokes.loc[0.0], strokes.attrs["bottom dead centre"]
    assert (stroke["slider.x"].idxmax() - bottom + math.pi) % math.tau - math.pi == pytest.approx(0.0, abs=math.tau / 2000)


def test_rough_bearings_touch_three_roughnesses_early_and_oil_is_squeezed_out():
    found = stack_up(fmu("press"), settings={"joint.B.lubrication": 2, "joint.B.roughness": 1e-6})
    assert found["difference"].to_numpy() == pytest.approx([0, -6e-6, 0, -6e-6], abs=1e-9)


def test_loads_that_a_weight_could_undo_are_refused():
    weight = (180 + 60 + 250) * 9.81
    with pytest.raises(ValueError, match="weight"):
        stack_up(fmu("press"), loads=[0.9 * weight, 1e4, 2e4, 4e4])
    with pytest.raises(ValueError, match="four"):
        stack_up(fmu("press"), loads=[1e4, 2e4, 4e4])
    with pytest.raises(KeyError, match="nonsense"):
        stack_up(fmu("press"), settings={"nonsense": 1.0})


def test_a_curve_begins_where_it_was_begun():
    levels = numpy.array([1.0, 2.0, 4.0, 8.0, 4.0, 2.0, 1.0])
    for exponent in (0.4, 2 / 3, 0.9):
        begin, given = curve(levels, 3.0 + 0.5 * levels**exponent)
        assert begin == pytest.approx(3.0, abs=1e-7) and given == pytest.approx(3.0 + 0.5 * levels**exponent, abs=1e-7)
    # What is no power is told of by its error.
    found = unloaded(pandas.Series(levels), pandas.Series(3.0 + 0.5 * numpy.log1p(levels)))
    assert 1e-3 < abs(found.begin - 3.0) < found.error


def test_an_ideal_guide_does_not_tilt_and_carries_the_load_s_couple():
    strokes = parallelism(fmu("ideal"), [-0.015, 0.0, 0.01], load=1000.0, turns=1.0)
    assert (strokes["slider.angle"] == 0.0).all()
    for offset, stroke in strokes.groupby(level="offset"):
        assert numpy.allclose(stroke["joint.T.moment"], 1000.0 * offset, rtol=1e-9, atol=1e-9)
        assert len(stroke) == 2001
    table = at_bottom_dead_centre(strokes)
    assert table.index.to_list() == [-0.015, 0.0, 0.01] and (table[["tilt", "largest"]] == 0.0).all(axis=None)


def test_the_mirrored_press_tilts_the_other_way():
    offsets = [0.1, -0.05]
    turned = {"drive.mode": 2, "crank.angle_start": 0.0, "crank.speed_start": 31.4}
    one = parallelism(fmu("press"), offsets, LOAD, 2.0, turned)
    other = parallelism(fmu("press"), [-offset for offset in offsets], LOAD, 2.0, turned | {"crank.speed_start": -31.4})
    for offset in offsets:
        ours, mirrored = one.loc[offset], other.loc[-offset]
        assert numpy.array_equal(ours["slider.angle"], -mirrored["slider.angle"].to_numpy())
        assert numpy.array_equal(ours["slider.x"], mirrored["slider.x"])
    tilts = at_bottom_dead_centre(one)["tilt"]
    # The couple of a load from below turns the slide towards the load's side, and more the farther it is.
    assert tilts[0.1] > 1.2 * -tilts[-0.05] > 0.0


def test_the_scene_s_own_load_tilts_the_slide_where_it_works():
    strokes = parallelism(fmu("press"), [0.0, 0.1], turns=2.0)
    table = at_bottom_dead_centre(strokes)
    # The sheet is cut 20 deg to 10 deg before bottom dead centre, and nothing presses there.
    assert 340.0 < math.degrees(table.loc[0.1, "angle"]) < 351.0
    assert table.loc[0.1, "largest"] > 5 * abs(table.loc[0.0, "largest"])
    assert abs(table.loc[0.1, "tilt"]) < 0.3 * table.loc[0.1, "largest"]
    with pytest.raises(ValueError, match="does not turn"):
        parallelism(fmu("press"), [0.0], settings={"crank.speed_start": 0.0})


def test_a_figure_of_parallelism_is_in_milliradians_around_bottom_dead_centre():
    index = pandas.MultiIndex.from_product([[0.05], [5.9, 6.1, 6.4]], names=["offset", "crank.angle"])
    strokes = pandas.DataFrame({"slider.angle": [1e-3, 2e-3, 3e-3]}, index=index)
    strokes.attrs["bottom dead centre"] = 0.1
    axes = plots.parallelism(strokes)
    (line,) = axes.get_lines()
    assert line.get_label() == "50 mm"
    around = numpy.degrees(numpy.array([5.9, 6.1, 6.4]) - 0.1 - 2 * math.pi)
    assert numpy.allclose(line.get_xydata(), numpy.column_stack([around, [1, 2, 3]]))


@pytest.fixture(scope="module")
def ma_qian(tmp_path_factory):
    return study(home() / "fmu-harness/studies/ma-qian.toml", output=tmp_path_factory.mktemp("ma-qian"))


def test_ma_and_qian_s_study_has_all_placements_and_sizes(ma_qian):
    table = placements(ma_qian)
    sizes = (0.0, 1e-4, 5e-4)
    assert list(table.index) == list(itertools.product(sizes, repeat=3)) and table.index.names == ["A", "B", "C"]
    assert (table["status"] == "ok").all()
    # Without any clearance the error is 0 and the forces are those of the closed form; 2718.7 N at the slider pin.
    assert table.loc[(0, 0, 0), "position_peak"] == 0.0
    assert table.loc[(0, 0, 0), "peak_force_C"] == pytest.approx(2718.7, abs=0.05)
    # The slider is off by the sum of the clearances at most, and by what contacts give way and the rod is inclined.
    reach = table.index.to_frame().sum(axis=1)
    played = table[reach > 0]
    assert (played["position_peak"] < 1.3 * reach[reach > 0]).all()
    assert (played["position_rms"] < played["position_peak"]).all()
    assert (played["peak_force_A"] > table.loc[(0, 0, 0), "peak_force_A"]).all()


def test_a_joint_that_a_study_does_not_vary_keeps_its_size():
    frame = pandas.DataFrame({f"joint.{joint}.clearance": [2e-4, 1e-4] for joint in "ABC"} | {"force": [2.0, 1.0]})
    table = placements(frame.assign(**{"joint.B.model": [2, 1]}))
    assert list(table.index) == [(1e-4, 0.0, 1e-4), (2e-4, 2e-4, 2e-4)] and table["force"].to_list() == [1.0, 2.0]


def test_a_study_without_a_clearance_has_no_placements():
    frame = pandas.DataFrame({"joint.B.clearance": [1e-4], "joint.C.clearance": [1e-4], "force": [1.0]})
    with pytest.raises(KeyError, match="the study has no `joint.A.clearance`: "):
        placements(frame)


def test_a_figure_of_placements_tells_every_value(ma_qian):
    table = placements(ma_qian)
    panels = plots.placements(table, "peak_force_C")
    assert [axes.get_title() for axes in panels] == ["A 0 mm", "A 0.1 mm", "A 0.5 mm"]
    for axes, size in zip(panels, (0.0, 1e-4, 5e-4)):
        values = table.loc[size, "peak_force_C"].to_numpy()
        assert numpy.array_equal(axes.get_images()[0].get_array().ravel(), values)
        assert [text.get_text() for text in axes.texts] == [f"{value:.3g}" for value in values]
        assert axes.get_images()[0].get_clim() == (table["peak_force_C"].min(), table["peak_force_C"].max())


def test_a_guide_out_of_reach_has_no_dead_centre():
    lengths = {"guide.offset": 0.8, "slider.centre.y": 0.0, "crank.length": 0.1, "rod.length": 0.5}
    with pytest.raises(ValueError, match="0.6 m long, do not reach the slider's pin, 0.8 m"):
        bottom_dead_centre(lengths.__getitem__)
    assert bottom_dead_centre({**lengths, "guide.offset": 0.3}.__getitem__) == pytest.approx(math.pi / 6)
