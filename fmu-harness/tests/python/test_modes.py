"""Solid models in CalculiX give the modes that theory gives, and the shipped table is what they give."""

import itertools
import math
import shutil
import subprocess
import tomllib

import numpy
import pytest
import scipy.sparse
import scipy.sparse.linalg

from slidercrank import package, simulate
from slidercrank.deck import HEXAHEDRON, Deck
from slidercrank.modes import (
    Found,
    Frame,
    ModesError,
    Pin,
    Sections,
    allowed_motion,
    assemble,
    from_calculix,
    integrals,
    modes,
    read_solid,
)
from slidercrank.rod import STEEL, Eye, Mesh, Rod, bar, rod
from slidercrank.source import home

needs_gmsh = pytest.mark.skipif(shutil.which("gmsh") is None, reason="gmsh is not installed (Debian: gmsh)")

LENGTH = 0.12
COARSE = Rod(big=Eye(0.016, 0.023, 0.008), small=Eye(0.01, 0.015, 0.008))
"""A rod with a flat side: fewer elements."""


@pytest.fixture(autouse=True)
def calculix():
    """Without it each test here is skipped, with a line that says so."""
    if shutil.which("ccx") is None:
        pytest.skip("ccx is not installed (Debian: calculix-ccx)")


def beam(width, thickness, bending, axial):
    """The built-in beam's table: exact shapes, integrals by a fine sum."""
    x, step = numpy.linspace(0.0, LENGTH, 20001, retstep=True)
    line = STEEL.density * width * thickness
    weight = numpy.full_like(x, step)
    weight[[0, -1]] *= 0.5
    waves = [i * math.pi / LENGTH for i in range(1, bending + 1)]
    phi = numpy.array([numpy.sin(wave * x) for wave in waves])
    psi = [numpy.sin((2 * j - 1) * math.pi * x / (2 * LENGTH)) * -((-1) ** j) for j in range(1, axial + 1)]
    gammas = []
    for i in range(bending):
        for j in range(i, bending):
            slope = 0.5 * waves[i] * waves[j] * numpy.cos(waves[i] * x) * numpy.cos(waves[j] * x)
            gammas.append(numpy.concatenate([[0.0], numpy.cumsum(0.5 * step * (slope[1:] + slope[:-1]))]))
    functions = numpy.array([x, *psi, *gammas])
    return {
        "shortening": numpy.array([gamma[-1] for gamma in gammas]),
        "first": line * functions @ weight,
        "second": line * (functions * weight) @ functions.T,
        "coupling": line * (functions * weight) @ phi.T,
        "bending": [wave**2 * width * math.sqrt(STEEL.young / (12.0 * STEEL.density)) for wave in waves],
        "axial": [(2 * j - 1) * math.pi / (2.0 * LENGTH) * math.sqrt(STEEL.young / STEEL.density) for j in range(1, axial + 1)],
    }


def shear_beam(mode, width):
    """[rad/s] Of the pinned beam that shears, and whose sections have inertia (Timoshenko 1921, Cowper 1966)."""
    young, poisson, density = STEEL.young, STEEL.poisson, STEEL.density
    shear = young / (2.0 * (1.0 + poisson)) * 10.0 * (1.0 + poisson) / (12.0 + 11.0 * poisson)
    wave, radius = (mode * math.pi / LENGTH) ** 2, width**2 / 12.0
    a = density**2 * radius / shear
    b = density * (1.0 + radius * wave * (1.0 + young / shear))
    return math.sqrt((b - math.sqrt(b * b - 4.0 * a * young * radius * wave**2)) / (2.0 * a))


def frequencies(modes):
    return numpy.array([mode.frequency for mode in modes])


def same(one, other, tolerance):
    """Two tables are the same, each integral in proportion to the most that it can be."""
    for kind in ("bending", "axial"):
        for a, b in zip(getattr(one, kind), getattr(other, kind), strict=True):
            assert list(vars(a).values()) == pytest.approx(list(vars(b).values()), rel=tolerance, abs=tolerance)
    size = numpy.sqrt(numpy.diag(other.second))
    across = numpy.sqrt([mode.mass for mode in other.bending])
    assert one.mass == pytest.approx(other.mass, rel=tolerance)
    assert one.first / size == pytest.approx(other.first / size, abs=tolerance)
    assert one.second / numpy.outer(size, size) == pytest.approx(other.second / numpy.outer(size, size), abs=tolerance)
    assert one.coupling / numpy.outer(size, across) == pytest.approx(other.coupling / numpy.outer(size, across), abs=tolerance)
    assert one.shortening == pytest.approx(other.shortening, rel=tolerance, abs=tolerance * abs(other.shortening).max())


# A uniform bar.


def test_a_slender_bar_is_the_built_in_beam_within_an_error_that_falls(deck):
    """A hundredth as wide as long: shear and the sections' inertia take 2e-4, 7e-4 and 1.5e-3 of the frequencies."""
    width = 0.01 * LENGTH
    wanted = beam(width, width, 3, 2)
    errors, integrals = [], []
    for elements in (8, 16, 32):
        table = from_calculix(deck(bar(LENGTH, width, width, (elements, 1, 1))), 3, 2)
        errors.append(frequencies(table.bending) / wanted["bending"] - 1.0)
        size = numpy.sqrt(numpy.diag(wanted["second"]))
        integrals.append(abs((table.second - wanted["second"]) / numpy.outer(size, size)).max())
    # 7e-3, 1.3e-3, 5e-5 of the first mode: what is left is shear.
    assert (abs(errors[1]) < 0.25 * abs(errors[0])).all() and (abs(errors[2]) < 0.1 * abs(errors[1])).all()
    assert abs(errors[2]).max() < 5e-4
    assert frequencies(table.axial) == pytest.approx(wanted["axial"], rel=3e-5)
    assert integrals[0] > integrals[1] > integrals[2] and integrals[2] < 1e-3
    assert table.mass == pytest.approx(STEEL.density * width**2 * LENGTH, rel=1e-9)
    assert table.first / (size * math.sqrt(table.mass)) == pytest.approx(wanted["first"] / (size * math.sqrt(table.mass)), abs=1e-3)
    across = size[:, None] * math.sqrt(0.5 * table.mass)
    assert table.coupling / across == pytest.approx(wanted["coupling"] / across, abs=1e-3)
    assert table.shortening == pytest.approx(wanted["shortening"], rel=1e-3, abs=1e-3 * wanted["shortening"].max())
    assert table.left_out == ()


def test_a_thick_bar_shears_as_timoshenko_s_beam(deck):
    """The bar of `flexrod`, an eighth as wide as long: shear takes 2.4 %, 8.6 % and 16 % of the frequencies."""
    width = 0.0149
    table = from_calculix(deck(bar(LENGTH, width, 0.015, (32, 4, 1))), 3, 1)
    wanted = [shear_beam(mode, width) for mode in (1, 2, 3)]
    assert frequencies(table.bending) == pytest.approx(wanted, rel=2.5e-3)
    # The section turns less than the axis: the shear is the difference.
    assert 0.95 < table.bending[0].slope_start * LENGTH / math.pi < 0.98
    assert table.bending[0].slope_end == pytest.approx(-table.bending[0].slope_start, rel=1e-6)
    # Its moment of inertia is that of the solid, which a line has not.
    assert table.second[0, 0] == pytest.approx(table.mass * (LENGTH**2 / 3.0 + width**2 / 12.0), rel=1e-9)


def test_units_place_and_the_other_half_make_no_difference(deck):
    width, thickness = 0.012, 0.01
    usual = from_calculix(deck(bar(LENGTH, width, thickness, (8, 1, 1))), 2, 1)
    # Millimetres and tonnes, turned and moved in the plane.
    mesh = Mesh()
    turn = lambda x, y: (40.0 + 0.8 * x - 0.6 * y, -7.0 + 0.6 * x + 0.8 * y)
    place = lambda s, t: turn(1e3 * LENGTH * s, 1e3 * width * (t - 0.5))
    half = 0.5e3 * thickness
    mesh.block(place, 8, 1, [-half, 0.0, half])
    along = lambda x, y: 0.8 * (x - 40.0) + 0.6 * (y + 7.0)
    sets = {
        "crank": mesh.at(lambda x, y, z: abs(along(x, y)) < 1e-6),
        "slider": mesh.at(lambda x, y, z: abs(along(x, y) - 1e3 * LENGTH) < 1e-6),
    }
    steel = type(STEEL)(young=STEEL.young * 1e-6, poisson=STEEL.poisson, density=STEEL.density * 1e-12)
    names = {"big_end": "Crank", "small_end": "Slider", "symmetry": None}
    other = from_calculix(deck(mesh.deck("whole", steel, sets).replace("crank", "CRANK")), 2, 1, **names, length=1e-3, mass=1e3)
    same(other, usual, 1e-6)


def test_matrices_that_are_there_already_are_read(deck, tmp_path):
    file = deck(bar(LENGTH, 0.01, 0.01, (4, 1, 1)))
    job = assemble(Deck(file).text, tmp_path, "ccx")
    same(from_calculix(file, 2, 1, results=job, program="nothing"), from_calculix(file, 2, 1), 1e-9)


def test_a_table_of_a_solid_bar_moves_as_the_built_in_beam(deck, tmp_path):
    width = 0.004
    common = f"""
drive.mode = "speed"
crank.speed_start = "3000 rpm"
rod.length = {LENGTH}
solver.tolerance = 1e-9
[rod.flexible]
bending_modes = 2
axial_modes = 1
"""
    from_calculix(deck(bar(LENGTH, width, width, (32, 1, 1))), 2, 1).write(tmp_path / "bar.toml")
    built_in = f"young = {STEEL.young}\ndensity = {STEEL.density}\narea = {width**2}\nsecond_moment = {width**4 / 12.0}\n"
    runs = []
    for name, rest in (("beam", built_in), ("solid", 'table = "bar.toml"\n')):
        scene = tmp_path / f"{name}-scene.toml"
        scene.write_text(f'name = "{name}-scene"\ndescription = "a bar"\n{common}{rest}')
        fmu = package(scene, tmp_path / f"{name}.fmu")
        runs.append(simulate(fmu, stop=0.02, step=1e-5, outputs=["rod.deflection", "rod.stretch"]))
    for output in ("rod.deflection", "rod.stretch"):
        most = abs(runs[0][output]).max()
        # A bar a thirtieth as wide as long shears by 2e-3 of its frequency, 0.03 rad after two hundred of the run's.
        assert most > 1e-7 and abs(runs[0][output] - runs[1][output]).max() < 0.05 * most, output


# A rod with two eyes.


def test_the_shipped_table_is_what_calculix_gives(deck):
    table = from_calculix(deck(rod()), 4, 2)
    scenes = home() / "fmu-harness/scenes"
    shipped = tomllib.loads((scenes / "modes/ferod.toml").read_text())
    made = tomllib.loads(table.text())
    assert table.length == pytest.approx(0.12, rel=1e-6) and table.left_out == ()
    for kind in ("bending", "axial"):
        for one, other in zip(made[kind], shipped[kind], strict=True):
            assert one == pytest.approx(other, rel=1e-5)
    for key in ("mass", "shortening", "first", "second", "coupling"):
        one, other = numpy.array(made[key]), numpy.array(shipped[key])
        assert one == pytest.approx(other, rel=1e-5, abs=1e-6 * abs(other).max()), key


def hexahedron(place):
    """Slopes of the 20 shape functions at a place of the cube from -1 to 1: polynomials that are 1 at their node."""
    corners = numpy.array([(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)], float)
    nodes = numpy.vstack([corners, [corners[list(edge)].mean(axis=0) for edge in HEXAHEDRON.edges]])
    powers = numpy.array([p for p in itertools.product(range(3), repeat=3) if sum(p) < 5 and p.count(2) < 2])
    shapes = numpy.linalg.inv([(node**powers).prod(axis=1) for node in nodes])
    slopes = []
    for axis in numpy.eye(3, dtype=int):
        lower = numpy.maximum(powers - axis, 0)
        slopes.append((powers @ axis * (place**lower).prod(axis=1)) @ shapes)
    return numpy.array(slopes)


def test_foreshortening_is_the_work_of_a_pull(deck):
    """Γ_ij is half the stress stiffness, ½∫σ_kl·∂_k u_i·∂_l u_j dV, of the solid under a pull of 1 N at the pins."""
    file = deck(rod())
    solid, big, small, plane = read_solid(file)
    frame = Frame(solid, big, small)
    pins = Pin(frame, big, 0.0), Pin(frame, small, frame.length)
    allowed = allowed_motion(frame, pins, plane, "mean")
    found = Found([], [], [])
    for frequency, shape in modes(frame, pins, allowed, 3, 0):
        found.sort(frequency, shape, Sections(frame))
        if len(found.bending) == 3:
            break
    table = integrals(frame, pins, Sections(frame), found.first(3, 0), 2.0)

    # Displacements under the pull, half of which acts on this half of the rod.
    pull = pins[1].mean(1.0, 0.0)
    held = allowed.T @ numpy.column_stack([pins[0].mean(1.0, 0.0), pins[0].mean(0.0, 1.0), pins[1].mean(0.0, 1.0)])
    stiffness = allowed.T @ solid.stiffness @ allowed
    scale = stiffness.diagonal().max()
    system = scipy.sparse.block_array([[stiffness / scale, held], [held.T, None]], format="csc")
    load = numpy.concatenate([allowed.T @ (0.5 * pull) / scale, numpy.zeros(3)])
    pulled = allowed @ scipy.sparse.linalg.spsolve(system, load)[: stiffness.shape[0]]

    row = {node: index for index, node in enumerate(solid.nodes)}
    elements = numpy.array([[row[node] for node in element] for element in Deck(file).elements])
    vectors = lambda full: numpy.where(solid.equations >= 0, full[solid.equations], 0.0)[elements]
    first = [shape.full * math.sqrt(0.5 * mode.mass) for mode, (_, shape) in zip(table.bending, found.bending)]
    first = [full * numpy.sign(pins[0].rotation(frame.components(full))) for full in first]
    stress_stiffness = numpy.zeros((3, 3))
    points, weights = numpy.polynomial.legendre.leggauss(3)
    for place in itertools.product(range(3), repeat=3):
        slopes = hexahedron(points[list(place)])
        turned = numpy.einsum("dn,enx->edx", slopes, solid.positions[elements])
        volume = numpy.linalg.det(turned) * weights[list(place)].prod()
        gradient = numpy.einsum("exd,dn->exn", numpy.linalg.inv(turned), slopes)
        of = lambda full: numpy.einsum("exn,enc->ecx", gradient, vectors(full))
        strain = 0.5 * (of(pulled) + of(pulled).transpose(0, 2, 1))
        shear = STEEL.young / (2.0 * (1.0 + STEEL.poisson))
        lame = 2.0 * shear * STEEL.poisson / (1.0 - 2.0 * STEEL.poisson)
        stress = 2.0 * shear * strain + lame * numpy.trace(strain, axis1=1, axis2=2)[:, None, None] * numpy.eye(3)
        bent = [of(full) for full in first]
        stress_stiffness += [[numpy.einsum("e,exy,ecx,ecy", volume, stress, a, b) for b in bent] for a in bent]
    # Half of it, of two halves.
    wanted = stress_stiffness[numpy.triu_indices(3)]
    most = numpy.sqrt(numpy.outer(stress_stiffness.diagonal(), stress_stiffness.diagonal()))[numpy.triu_indices(3)]
    # 0.6 %, 1.3 % and 0.5 % on the diagonal, 3 % between the first mode and the third.
    assert abs(table.shortening - wanted)[[0, 3, 5]] / most[[0, 3, 5]] == pytest.approx([0.0] * 3, abs=0.014)
    assert (abs(table.shortening - wanted) / most).max() < 0.03


def test_rigid_bores_stiffen_the_rod(deck):
    file = deck(rod(COARSE, fineness=1))
    soft, stiff = (from_calculix(file, 2, 1, bore=bore) for bore in ("mean", "rigid"))
    assert (frequencies(stiff.bending) > frequencies(soft.bending)).all()
    assert frequencies(stiff.axial) > frequencies(soft.axial)
    assert stiff.mass == pytest.approx(soft.mass, rel=1e-12)
    # A rigid bore's mean is its centre: the pin's place, and the products that no mode enters, are the same.
    assert stiff.second[0, 0] == pytest.approx(soft.second[0, 0], rel=1e-12)


@needs_gmsh
def test_tetrahedra_of_gmsh_give_the_same_rod(deck, tmp_path):
    script = home() / "fmu-harness/python/rod.geo"
    sizes = ["-setnumber", "fillet", "0", "-setnumber", "size", "0.004"]
    subprocess.run(["gmsh", "-3", *sizes, script, "-o", tmp_path / "mesh.inp"], check=True, capture_output=True)
    rest = f"*MATERIAL, NAME=STEEL\n*ELASTIC\n{STEEL.young}, {STEEL.poisson}\n*DENSITY\n{STEEL.density}\n"
    file = deck(f"*INCLUDE, INPUT=mesh.inp\n{rest}*SOLID SECTION, ELSET=ROD, MATERIAL=STEEL\n")
    table = from_calculix(file, 3, 1)
    shipped = tomllib.loads((home() / "fmu-harness/scenes/modes/ferod.toml").read_text())
    assert table.length == pytest.approx(0.12, rel=1e-5)
    # Both meshes are within 1 % of a fine one.
    assert table.mass == pytest.approx(shipped["mass"], rel=1e-3)
    assert frequencies(table.bending) == pytest.approx([mode["frequency"] for mode in shipped["bending"][:3]], rel=1e-2)
    assert frequencies(table.axial) == pytest.approx([mode["frequency"] for mode in shipped["axial"][:1]], rel=1e-2)
    # B: x, the axial mode, Γ11, where the shipped table has a second axial mode.
    assert table.second[:3, :3] == pytest.approx(numpy.array(shipped["second"])[numpy.ix_([0, 1, 3], [0, 1, 3])], rel=2e-2)
    assert table.shortening[0] == pytest.approx(shipped["shortening"][0], rel=1e-2)


# What is refused.


def test_a_deck_of_no_rod_is_refused(deck):
    whole = bar(LENGTH, 0.01, 0.01, (4, 1, 1))
    with pytest.raises(ModesError, match="no set of nodes PIN; there are: ALL, BIG_END, SMALL_END, SYMMETRY"):
        from_calculix(deck(whole), big_end="pin")
    with pytest.raises(ModesError, match=r"\*ERROR"):
        from_calculix(deck(whole.replace("MATERIAL=ROD", "MATERIAL=NONE")))
    with pytest.raises(ModesError, match="held in the plane"):
        from_calculix(deck(whole + "*BOUNDARY\nBIG_END, 1\n"))
    with pytest.raises(ModesError, match="covers no face"):
        from_calculix(deck(whole + "*NSET, NSET=LINE\n1, 2\n"), big_end="line")
    mesh = Mesh()
    mesh.block(lambda s, t: (LENGTH * s, 0.01 * (t - 0.5) + 0.04 * s * (1.0 - s)), 8, 1, [0.0, 0.005])
    sets = {"BIG_END": mesh.at(lambda x, y, z: x == 0.0), "SMALL_END": mesh.at(lambda x, y, z: x == LENGTH)}
    bent = mesh.deck("bent", STEEL, sets | {"SYMMETRY": mesh.at(lambda x, y, z: z == 0.0)})
    with pytest.raises(ModesError, match="not symmetric about its axis"):
        from_calculix(deck(bent), 1, 0)
    with pytest.raises(ValueError, match="9 bending modes"):
        from_calculix(deck(whole), 9)
