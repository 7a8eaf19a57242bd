"""Sobol indices of a sum, and the counterweight that a parabola tells."""

import numpy
import pytest

from slidercrank.optimise import minimise
from slidercrank.recipe import RunError
from slidercrank.sensitivity import sobol

from conftest import fmu

REACH = """
name = "reach"
scene = "ideal"
table = "design.csv"

[run]
turns = 0.001
step = 1e-5

[keep]
reach = { of = "slider.x", reduce = "max" }
"""
"""At the outer dead centre the slider is as far as crank and rod are long."""

BALANCE = """
name = "balance"
scene = "ideal"

[run]
turns = 1
step = 5e-5

[keep]
force = { of = "joint.A.force", reduce = "rms" }
"""

BOUNDS = {"crank.length": (0.045, 0.055), "rod.length": (0.11, 0.13)}


def test_indices_of_a_sum_are_the_shares_of_its_variance(write, tmp_path):
    frame = sobol(write(REACH), BOUNDS, samples=256, seed=1, output=tmp_path)
    ranges = numpy.array([high - low for low, high in BOUNDS.values()])
    shares = ranges**2 / sum(ranges**2)
    for (name, share) in zip(BOUNDS, shares):
        row = frame.loc[("reach", name)]
        assert abs(row["ST"] - share) < 0.02 and abs(row["S1"] - share) < max(2 * row["S1_conf"], 0.02)
        assert 0.0 < row["ST_conf"] < 0.3
    # Again, from the journal, with the same confidence.
    assert sobol(write(REACH), BOUNDS, samples=256, seed=1, output=tmp_path).equals(frame)


@pytest.mark.parametrize(
    "text, bounds, samples, word",
    [
        (REACH.replace("table", "#"), BOUNDS, 8, "table"),
        (REACH + "[grid]\n\"slider.mass\" = [0.1, 0.2]\n", BOUNDS, 8, "grid"),
        (REACH, BOUNDS, 12, "power of two"),
        (REACH, {"crank.length": (0.05, 0.05)}, 8, "not below"),
        (REACH, {}, 8, "there are no bounds"),
        (BALANCE.replace("[run]", 'table = "design.csv"\n[run]'), {"crank.length": (0.13, 0.3)}, 2, "runs failed"),
    ],
)
def test_what_cannot_be_analysed_is_told(write, tmp_path, text, bounds, samples, word):
    with pytest.raises(ValueError, match=word):
        sobol(write(text), bounds, samples, output=tmp_path)


def test_the_best_counterweight_is_the_vertex_of_the_parabola(write):
    # At a given speed the bearing's force is linear in the crank's centre of mass, and its mean square a parabola.
    name, file = "crank.com.x", write(BALANCE)
    search = lambda bounds, **told: minimise(file, fmu("ideal"), "force", {name: bounds}, **told)
    runs = search((-0.2, 0.2), seed=0, evaluations=5).evaluations
    curve = numpy.polyfit(runs[name], runs["value"] ** 2, 2)
    vertex = -curve[1] / (2 * curve[0])
    assert -0.2 < vertex < 0.2
    for method in ("nelder_mead", "differential_evolution"):
        found = search((-0.2, 0.2), method=method, evaluations=120, tolerance=1e-4)
        assert found.parameters[name] == pytest.approx(vertex, abs=1e-3)
        assert found.evaluations[name].between(-0.2, 0.2).all() and len(found.evaluations) <= 120
    # Beyond the vertex the best is the bound.
    assert search((vertex + 0.01, 0.2), method="nelder_mead").parameters[name] == pytest.approx(vertex + 0.01, abs=1e-4)


def test_gradients_find_the_same_optimum_in_fewer_runs(write):
    name, bounds = "crank.com.x", (-0.2, 0.2)
    search = lambda method: minimise(
        write(BALANCE), fmu("ideal"), "force", {name: bounds, "crank.mass": (0.2, 0.4)}, method=method, tolerance=1e-4
    )
    plain, exact = search("nelder_mead"), search("gradient")
    assert exact.method == "L-BFGS-B" and "tell the change" in exact.reason
    assert plain.method == "Nelder-Mead" and plain.reason == "asked for"
    # Force and optimum depend on the product of mass and place alone.
    product = lambda found: found.parameters[name] * found.parameters["crank.mass"]
    assert product(exact) == pytest.approx(product(plain), rel=1e-3)
    assert exact.value == pytest.approx(plain.value, rel=1e-6)
    assert 2 * len(exact.evaluations) < len(plain.evaluations)
    # A maximum at a corner.
    far = minimise(write(BALANCE), fmu("ideal"), "force", {name: bounds}, method="gradient", maximise=True)
    assert abs(far.parameters[name]) == pytest.approx(0.2) and far.method == "L-BFGS-B"


def test_where_derivatives_do_not_reach_the_search_goes_on_without(write):
    chaotic = BALANCE.replace("ideal", "wornpin").replace("turns = 1", "turns = 2")
    found = minimise(
        write(chaotic), fmu("wornpin"), "force", {"joint.C.clearance": (2e-4, 5e-4)}, method="gradient", evaluations=12
    )
    assert found.method == "Nelder-Mead" and "derivatives do not reach 1% of the ranges" in found.reason
    rigid = chaotic.replace('reduce = "rms"', 'reduce = "peak"').replace("joint.A.force", "joint.C.contact")
    found = minimise(
        write(rigid), fmu("wornpin"), "force", {"joint.C.clearance": (2e-4, 5e-4)}, method="gradient", evaluations=4
    )
    assert found.method == "Nelder-Mead" and "`joint.C.contact` is not a real output" in found.reason


def test_where_derivatives_tell_nothing_the_search_goes_on_without(write):
    # Ideal joints have no error, and what was dissipated has no derivative by the phase.
    for output, why in [("accuracy.position", "all derivatives in the middle are 0"), ("energy.dissipated", "is a sum")]:
        file = write(BALANCE.replace("joint.A.force", output).replace("rms", "mean").replace("turns = 1", "turns = 0.1"))
        found = minimise(file, fmu("ideal"), "force", {"slider.mass": (0.1, 0.2)}, method="gradient", evaluations=6)
        assert found.method == "Nelder-Mead" and why in found.reason
        assert len(found.evaluations["slider.mass"].unique()) > 2


@pytest.mark.parametrize(
    "bounds, evaluations, why",
    [
        ({}, 6, "there are no bounds"),
        (BOUNDS, 0, "evaluations = 0: wanted at least 1"),
        (BOUNDS, -1, "evaluations = -1: wanted at least 1"),
        (BOUNDS | {"rod.flexible.bending_modes": (0, 3)}, 6, "`rod.flexible.bending_modes` is not a real parameter or input"),
        ({"energy.audit": (0, 1)}, 6, "`energy.audit` is not a real parameter"),
        ({"slider.x": (0.0, 1.0)}, 6, "`slider.x` is not a real parameter"),
    ],
)
def test_a_search_that_has_no_runs_or_no_room_is_refused(write, bounds, evaluations, why):
    with pytest.raises(ValueError, match=why):
        minimise(write(BALANCE), fmu("ideal"), "force", bounds, evaluations=evaluations)


def test_a_search_over_nothing_known_is_refused(write):
    with pytest.raises(RunError, match="no variable `crank.size`"):
        minimise(write(BALANCE), fmu("ideal"), "force", {"crank.size": (0.0, 1.0)})


def test_a_search_is_its_seed_s(write):
    search = lambda seed: minimise(write(BALANCE), fmu("ideal"), "force", BOUNDS, seed=seed, evaluations=6)
    assert search(1).evaluations.equals(search(1).evaluations)
    assert not search(1).evaluations.equals(search(2).evaluations)


def test_runs_that_fail_are_infinitely_bad_and_told(write):
    found = minimise(write(BALANCE), fmu("ideal"), "force", {"crank.length": (0.05, 0.3)}, maximise=True, evaluations=12)
    failed = found.evaluations[found.evaluations["status"] != "ok"]
    # A crank longer than its rod does not turn.
    assert 0 < len(failed) < 12 and found.parameters["crank.length"] < 0.12
    assert (failed["crank.length"] > 0.12).all()
    with pytest.raises(KeyError, match="keeps no `mass`"):
        minimise(write(BALANCE), fmu("ideal"), "mass", BOUNDS)
    with pytest.raises(ValueError, match="wanted differential_evolution, nelder_mead, gradient"):
        minimise(write(BALANCE), fmu("ideal"), "force", BOUNDS, method="newton")
