"""A rod's table of modes from a solid model in CalculiX.

`from_calculix("rod.inp")` has CalculiX (the program `ccx`; Debian's package `calculix-ccx`) assemble the stiffness and mass
matrices of a deck, finds the modes of the rod between its pins and writes what a scene takes as `rod.flexible.table`:

    from_calculix("rod.inp", bending=3, axial=1).write("rod.toml")

`python -m slidercrank.modes rod.inp -o rod.toml` does the same. `slidercrank.rod` writes decks.

The deck. Solid elements with material and density; the plane of motion is the deck's x-y plane. Two sets of nodes are the
surfaces of the bores, BIG_END and SMALL_END; their centres are the pins. Usually the deck holds the half of the rod on one
side of the plane of motion, and the nodes in that plane are the set SYMMETRY. Steps are left out. What CalculiX holds by
`*BOUNDARY`, `*MPC` or `*EQUATION` outside of steps stays held, but no node may be held in the plane.

The modes. In the rod's own frame, on the chord from pin to pin, the big end's pin rests and the small end's pin moves along
the chord. A pin is the mean of its bore's surface, over its area, in displacement and rotation; the bore itself remains
elastic (`bore="mean"`) or moves as a rigid ring (`bore="rigid"`). A mode counts as bending or axial by
the part of its kinetic energy that is a motion of whole sections across or along the chord; modes with too little of both,
such as an eye that becomes oval, are left out and listed.

The integrals. Every product of the table is taken with CalculiX's mass matrix over the whole displacement field, not over a
line, so that the rotation of sections and the width of the eyes count. The deflection φ(x) of sections, a spline fitted to
the field, gives the foreshortening Γ(x) = ½∫φ_i'·φ_j' ds; each section keeps its form when it shortens, which turns its
points at a distance y from the axis by ½·y·φ_i'·φ_j' towards the axis.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Literal

import numpy
import pandas
import scipy.sparse
from numpy.typing import NDArray
from scipy.interpolate import BSpline, PPoly
from scipy.sparse.linalg import LinearOperator, eigsh, splu

from .deck import Deck, ModesError, Vector

Bore = Literal["mean", "rigid"]

MOST = 8
"""Most bending modes, and axial modes, of a table."""
SECTION_SHARE = 0.3
"""Least share of a mode's kinetic energy in the motion of sections: less is no mode of a rod."""
ASYMMETRY = 1e-2
"""Largest mixture of bending with rotation-free motion along the rod, as a cosine: a table has no place for more."""
DEGREE = 5
"""Degree of the spline through the sections' motion."""
INTERVALS = 24
"""Most intervals of that spline."""
SMOOTHING = 1e-10
"""Weight of the spline's curvature, of the rod's mass times its length to the third: keeps the fit regular."""


@dataclass(frozen=True)
class Bending:
    """A bending mode, of the largest deflection 1: [rad/s] frequency, ∫φ²dm, ∫φdm, φ(l/2), slopes at the pins."""

    frequency: float
    mass: float
    moment: float
    middle: float
    slope_start: float
    slope_end: float


@dataclass(frozen=True)
class Axial:
    """An axial mode that moves the small end's pin by 1: [rad/s] frequency, ∫ψ²dm, ψ(l)."""

    frequency: float
    mass: float
    end: float


@dataclass(frozen=True)
class Table:
    """A table of modes, with the keys of `rod.flexible.table`, in SI units."""

    length: float
    """[m] From pin to pin: the scene's `rod.length` must be this. Not in the file."""
    mass: float
    bending: tuple[Bending, ...]
    axial: tuple[Axial, ...]
    shortening: Vector
    first: Vector
    second: Vector
    coupling: Vector
    left_out: tuple[float, ...]
    """[rad/s] Frequencies of modes below the last one of the table that are neither bending nor axial. Not in the file."""

    def text(self) -> str:
        """The file that a scene names."""
        rows = lambda matrix: "[\n" + "".join(f"  {numbers(row)},\n" for row in matrix) + "]"
        lines = [f"mass = {number(self.mass)}"]
        lines += [f"{name} = {numbers(getattr(self, name))}" for name in ("shortening", "first")]
        lines += [f"{name} = {rows(getattr(self, name))}" for name in ("second", "coupling")]
        for kind, modes in (("bending", self.bending), ("axial", self.axial)):
            for mode in modes:
                lines += ["", f"[[{kind}]]"]
                lines += [f"{key} = {number(value)}" for key, value in vars(mode).items()]
            if not modes:
                lines.insert(0, f"{kind} = []")
        return "\n".join(lines) + "\n"

    def write(self, file: str | Path, remark: str = "") -> None:
        """Writes the file, below a `remark` of any number of lines."""
        comment = "".join(f"# {line}\n" for line in remark.splitlines())
        Path(file).write_text(comment + self.text(), encoding="utf-8")


def number(value: float) -> str:
    """Ten digits, as a float of TOML."""
    text = f"{value:.10g}"
    return text if any(letter in text for letter in ".e") else f"{text}.0"


def numbers(values: Vector) -> str:
    return "[" + ", ".join(map(number, values)) + "]"


def from_calculix(
    deck: str | Path,
    bending: int = 3,
    axial: int = 1,
    *,
    bore: Bore = "mean",
    big_end: str = "BIG_END",
    small_end: str = "SMALL_END",
    symmetry: str | None = "SYMMETRY",
    length: float = 1.0,
    mass: float = 1.0,
    results: str | Path | None = None,
    program: str = "ccx",
) -> Table:
    """The table of a deck's modes.

    `big_end`, `small_end` and `symmetry` name sets of nodes; `symmetry=None` takes the deck for the whole rod. `length` is
    the deck's unit of length in metres and `mass` that of mass in kilograms, time being in seconds: 1e-3 and 1e3 for a deck
    in mm, t, N, MPa. `results` is the path, without ending, of the files .sti, .mas and .dof that CalculiX has written for
    this deck already (`*FREQUENCY, SOLVER=MATRIXSTORAGE`); without it CalculiX runs.
    """
    solid, big, small, plane = read_solid(deck, big_end, small_end, symmetry, length, mass, results, program)
    return condense(solid, big, small, plane, bending, axial, bore)


def read_solid(
    deck: str | Path,
    big_end: str = "BIG_END",
    small_end: str = "SMALL_END",
    symmetry: str | None = "SYMMETRY",
    length: float = 1.0,
    mass: float = 1.0,
    results: str | Path | None = None,
    program: str = "ccx",
) -> tuple[Solid, Surface, Surface, NDArray[numpy.intp] | None]:
    """Matrices of a deck in SI units, the surfaces of its bores, rows of the nodes in the plane of symmetry."""
    read = Deck(Path(deck))
    if results is None:
        with TemporaryDirectory(prefix="modes-") as folder:
            solid = read_matrices(assemble(read.text, Path(folder), program), read.nodes)
    else:
        solid = read_matrices(Path(results), read.nodes)
    solid = Solid(solid.nodes, solid.positions * length, solid.equations, solid.stiffness * mass, solid.mass * mass)

    def surface(name: str) -> Surface:
        area = read.surface(read.members(name))
        weight = numpy.array([area.get(node, 0.0) for node in solid.nodes])
        return Surface(numpy.flatnonzero(weight), weight[weight != 0.0])

    plane = numpy.flatnonzero(numpy.isin(solid.nodes, list(read.members(symmetry)))) if symmetry else None
    return solid, surface(big_end), surface(small_end), plane


# The matrices.


def assemble(text: list[str], folder: Path, program: str) -> Path:
    """Has CalculiX write the matrices of a deck into `folder`; their path without ending."""
    if shutil.which(program) is None:
        raise ModesError(f"{program} is not installed; Debian's package is calculix-ccx")
    step = ["*STEP", "*FREQUENCY, SOLVER=MATRIXSTORAGE", "1", "*END STEP"]
    job = folder / "rod"
    job.with_suffix(".inp").write_text("\n".join([*text, *step]) + "\n", encoding="utf-8")
    threads = {"OMP_NUM_THREADS": os.environ.get("OMP_NUM_THREADS", "1")}
    done = subprocess.run([program, "-i", job.name], cwd=folder, env=os.environ | threads, capture_output=True, text=True)
    if done.returncode != 0 or not job.with_suffix(".dof").is_file():
        told = [line.strip() for line in (done.stdout + done.stderr).splitlines() if line.strip()]
        wrong = [index for index, line in enumerate(told) if "*ERROR" in line]
        raise ModesError(f"{program}: " + " ".join(told[wrong[0] :][:4] if wrong else told[-4:]))
    return job


@dataclass(frozen=True)
class Solid:
    """Matrices of a solid model."""

    nodes: NDArray[numpy.int64]
    """Numbers of the nodes that elements use."""
    positions: Vector
    """A row for each of them."""
    equations: NDArray[numpy.int64]
    """Row of the matrices for each node and direction; -1 for one that is held."""
    stiffness: scipy.sparse.csc_array
    mass: scipy.sparse.csc_array


def read_matrices(job: Path, positions: dict[int, tuple[float, float, float]]) -> Solid:
    """The matrices that CalculiX wrote: the upper triangles, and `node.direction` for each row."""
    try:
        words = [line.split(".") for line in job.with_suffix(".dof").read_text().split()]
        places = numpy.array([(int(node), int(direction)) for node, direction in words])
        count = len(places)

        def symmetric(ending: str) -> scipy.sparse.csc_array:
            table = pandas.read_csv(job.with_suffix(ending), sep=r"\s+", header=None, names=["row", "column", "value"])
            table = table[table["value"] != 0.0]
            row, column, value = (table[name].to_numpy() for name in table)
            upper = scipy.sparse.coo_array((value, (row - 1, column - 1)), shape=(count, count)).tocsr()
            return scipy.sparse.csc_array(upper + scipy.sparse.triu(upper, 1).T)

        stiffness, mass = symmetric(".sti"), symmetric(".mas")
    except (OSError, ValueError) as error:
        raise ModesError(f"{job}: the matrices cannot be read: {error}") from error
    nodes, row = numpy.unique(places[:, 0], return_inverse=True)
    equations = numpy.full((len(nodes), 3), -1)
    equations[row, places[:, 1] - 1] = numpy.arange(count)
    if (equations[:, :2] < 0).any():
        held = nodes[(equations[:, :2] < 0).any(axis=1)][0]
        raise ModesError(f"{job}: node {held} is held in the plane of motion by the deck itself")
    return Solid(nodes, numpy.array([positions[node] for node in nodes]), equations, stiffness, mass)


# The modes.


@dataclass(frozen=True)
class Surface:
    """The surface of a bore: rows of the solid's nodes, and each node's part of the area, below 0 for some corners."""

    nodes: NDArray[numpy.intp]
    area: Vector


@dataclass(frozen=True)
class Field:
    """Displacements in the rod's frame as a vector of the matrices, with a pair of components for each node."""

    full: Vector
    along: Vector
    across: Vector


class Frame:
    """The rod's frame: origin at the big end's pin, x axis through the small end's pin."""

    def __init__(self, solid: Solid, big: Surface, small: Surface) -> None:
        self.solid = solid
        # Share of each node in the mass of its elements, positive where a row's sum is not.
        self.weight: Vector = solid.mass.diagonal()[solid.equations[:, 0]]
        ends = [numpy.average(solid.positions[end.nodes, :2], axis=0, weights=end.area) for end in (big, small)]
        chord = ends[1] - ends[0]
        self.length = float(numpy.hypot(*chord))
        self.axis: Vector = chord / self.length
        self.normal: Vector = numpy.array([-self.axis[1], self.axis[0]])
        self.x: Vector = (solid.positions[:, :2] - ends[0]) @ self.axis
        self.y: Vector = (solid.positions[:, :2] - ends[0]) @ self.normal

    def field(self, along: Vector, across: Vector) -> Field:
        """The field with these components at the nodes and none out of the plane."""
        full = numpy.zeros(self.solid.mass.shape[0])
        for direction in range(2):
            full[self.solid.equations[:, direction]] = along * self.axis[direction] + across * self.normal[direction]
        return Field(full, along, across)

    def components(self, full: Vector) -> Field:
        """The field of a vector of the matrices."""
        x, y = full[self.solid.equations[:, 0]], full[self.solid.equations[:, 1]]
        return Field(full, x * self.axis[0] + y * self.axis[1], x * self.normal[0] + y * self.normal[1])


@dataclass(frozen=True)
class Pin:
    """The mean motion of a bore's surface."""

    frame: Frame
    surface: Surface
    end: float
    """[m] x of the pin."""

    @property
    def nodes(self) -> NDArray[numpy.intp]:
        return self.surface.nodes

    @property
    def share(self) -> Vector:
        area: Vector = self.surface.area / self.surface.area.sum()
        return area

    @property
    def arm(self) -> tuple[Vector, Vector]:
        """From the pin to each node."""
        return self.frame.x[self.nodes] - self.end, self.frame.y[self.nodes]

    def mean(self, along: float, across: float) -> Vector:
        """Mean displacement in a direction, as a row to be multiplied with a vector of the matrices."""
        share = numpy.zeros(len(self.frame.x))
        share[self.nodes] = self.share
        return self.frame.field(share * along, share * across).full

    def rotation(self, field: Field) -> float:
        """Rotation that fits the surface's displacements best."""
        x, y = self.arm
        turned = (self.share * (x * field.across[self.nodes] - y * field.along[self.nodes])).sum()
        return float(turned / (self.share * (x * x + y * y)).sum())


def condense(
    solid: Solid,
    big: Surface,
    small: Surface,
    symmetry: NDArray[numpy.intp] | None,
    bending: int,
    axial: int,
    bore: Bore = "mean",
) -> Table:
    """The table of a solid model in SI units; `symmetry` are rows of its nodes."""
    for kind, count in (("bending", bending), ("axial", axial)):
        if not 0 <= count <= MOST:
            raise ValueError(f"{count} {kind} modes: 0 to {MOST} are possible")
    for name, surface in (("big", big), ("small", small)):
        if not len(surface.nodes):
            raise ModesError(f"the set of nodes of the {name} end covers no face of an element")
    frame = Frame(solid, big, small)
    pins = Pin(frame, big, 0.0), Pin(frame, small, frame.length)
    sections = Sections(frame)
    copies = 1.0 if symmetry is None else 2.0
    allowed = allowed_motion(frame, pins, symmetry, bore)
    found = Found([], [], [])
    for frequency, shape in modes(frame, pins, allowed, bending, axial):
        found.sort(frequency, shape, sections)
        if len(found.bending) >= bending and len(found.axial) >= axial:
            break
    else:
        raise ModesError(f"{len(found.bending)} bending and {len(found.axial)} axial modes were found, fewer than asked for")
    return integrals(frame, pins, sections, found.first(bending, axial), copies)


def allowed_motion(frame: Frame, pins: tuple[Pin, Pin], symmetry: NDArray[numpy.intp] | None, bore: Bore) -> scipy.sparse.csc_array:
    """Columns of which every motion consists: symmetric to the plane, and with rigid bores if they are asked for."""
    solid = frame.solid
    count = solid.mass.shape[0]
    free = numpy.ones(count, bool)
    if symmetry is not None:
        held = solid.equations[symmetry, 2]
        free[held[held >= 0]] = False
    columns: list[Vector] = []
    if bore == "rigid":
        for pin in pins:
            x, y = pin.arm
            free[solid.equations[pin.nodes, :2]] = False
            for along, across in ((1.0, 0.0), (0.0, 1.0), (-y, x)):
                parts = numpy.zeros((2, len(frame.x)))
                parts[0, pin.nodes], parts[1, pin.nodes] = along, across
                columns.append(frame.field(*parts).full)
    elif bore != "mean":
        raise ValueError(f"bore = {bore!r}: wanted mean or rigid")
    identity = scipy.sparse.identity(count, format="csc")[:, free]
    return scipy.sparse.csc_array(scipy.sparse.hstack([identity, *(column[:, None] for column in columns)]))


def modes(
    frame: Frame, pins: tuple[Pin, Pin], allowed: scipy.sparse.csc_array, bending: int, axial: int
) -> Iterator[tuple[float, Field]]:
    """Modes between the pins in ascending order: [rad/s] frequency and field of modal mass 1 in this model."""
    stiffness, mass = (scipy.sparse.csc_array(allowed.T @ matrix @ allowed) for matrix in (frame.solid.stiffness, frame.solid.mass))
    held = allowed.T @ numpy.column_stack([pins[0].mean(1.0, 0.0), pins[0].mean(0.0, 1.0), pins[1].mean(0.0, 1.0)])
    # A shift below 0 keeps the matrix positive without the supports: somewhat less than the first mode's, by its guess.
    wave = numpy.pi / frame.length
    guess = frame.field(-frame.y * wave * numpy.cos(wave * frame.x), numpy.sin(wave * frame.x)).full
    shift = -0.1 * float(guess @ (frame.solid.stiffness @ guess)) / float(guess @ (frame.solid.mass @ guess))
    options = {"SymmetricMode": True}
    factor = splu(scipy.sparse.csc_matrix(stiffness - shift * mass), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    reactions = factor.solve(held)
    flexibility = numpy.linalg.inv(held.T @ reactions)

    def solve(load: Vector) -> Vector:
        """Displacements under a load with the pins held."""
        moved: Vector = factor.solve(load.ravel())
        moved -= reactions @ (flexibility @ (held.T @ moved))
        return moved

    size = mass.shape[0]
    inverse = LinearOperator((size, size), matvec=solve, dtype=numpy.float64)
    start = solve(mass @ numpy.random.default_rng(0).standard_normal(size))
    done = 0
    for count in (bending + axial + 4, 2 * (bending + axial) + 12, 6 * (bending + axial) + 40):
        count = min(count, size - 4)
        squares, shapes = eigsh(stiffness, count, mass, sigma=shift, OPinv=inverse, v0=start)
        order = numpy.argsort(squares)
        for index in order[done:]:
            if squares[index] <= 0.0:
                raise ModesError("the rod can move between its pins without force: is it whole, and held in its plane?")
            yield float(numpy.sqrt(squares[index])), frame.components(allowed @ shapes[:, index])
        done = count


class Sections:
    """Splines along the rod through the motion of its sections."""

    def __init__(self, frame: Frame) -> None:
        self.frame = frame
        low, high = frame.x.min(), frame.x.max()
        planes = len(numpy.unique(numpy.round(frame.x / frame.length, 4)))
        self.breaks = numpy.linspace(low, high, min(INTERVALS, max(1, (planes - 1) // 2)) + 1)
        self.knots = numpy.concatenate([[low] * DEGREE, self.breaks, [high] * DEGREE])
        self.values = BSpline.design_matrix(numpy.clip(frame.x, low, high), self.knots, DEGREE)
        # Gauss's points integrate the square of the second derivative exactly.
        points, weights = numpy.polynomial.legendre.leggauss(DEGREE)
        half = 0.5 * numpy.diff(self.breaks)
        places = (0.5 * (self.breaks[1:] + self.breaks[:-1])[:, None] + half[:, None] * points).ravel()
        bent = BSpline(self.knots, numpy.eye(self.values.shape[1]), DEGREE).derivative(2)(places)
        stiffness = bent.T @ (bent * (half[:, None] * weights).ravel()[:, None])
        smooth = SMOOTHING * frame.weight.sum() * frame.length**3
        self.normal = (self.values.T @ (self.values * frame.weight[:, None])).toarray() + smooth * stiffness

    def fit(self, motion: Vector) -> BSpline:
        """The spline through a component at all nodes, by least squares over their mass."""
        return BSpline(self.knots, numpy.linalg.solve(self.normal, self.values.T @ (self.frame.weight * motion)), DEGREE)

    def share(self, motion: Vector) -> float:
        """Kinetic energy of the sections' mean motion."""
        return float((self.frame.weight * self.fit(motion)(self.frame.x) ** 2).sum())

    def shortening(self, one: BSpline, other: BSpline) -> Callable[[Any], Any]:
        """Γ(x) = ½∫φ_i'·φ_j' ds from the big end's pin."""
        left, right = (PPoly.from_spline(spline.derivative()) for spline in (one, other))
        kept = numpy.diff(left.x) > 0.0
        products = [numpy.convolve(a, b) for a, b in zip(left.c.T[kept], right.c.T[kept])]
        sums = PPoly(0.5 * numpy.array(products).T, self.breaks).antiderivative()
        return lambda x: sums(x) - sums(0.0)


@dataclass
class Found:
    """Modes with their frequencies, by kind."""

    bending: list[tuple[float, Field]]
    axial: list[tuple[float, Field]]
    other: list[float]

    def sort(self, frequency: float, shape: Field, sections: Sections) -> None:
        weight = sections.frame.weight
        # Lumped like the sections' motion; the mass out of the plane counts as well.
        out = sections.frame.solid.equations[:, 2]
        rest = numpy.where(out >= 0, shape.full[out], 0.0)
        whole = (weight * (shape.along**2 + shape.across**2 + rest**2)).sum()
        along, across = sections.share(shape.along) / whole, sections.share(shape.across) / whole
        if max(along, across) < SECTION_SHARE:
            self.other.append(frequency)
        else:
            (self.axial if along > across else self.bending).append((frequency, shape))

    def first(self, bending: int, axial: int) -> Found:
        kept = Found(self.bending[:bending], self.axial[:axial], [])
        last = max((frequency for frequency, _ in kept.bending + kept.axial), default=0.0)
        kept.other = [frequency for frequency in self.other if frequency < last]
        return kept


# The integrals.


def integrals(frame: Frame, pins: tuple[Pin, Pin], sections: Sections, found: Found, copies: float) -> Table:
    """The table of these modes, of a rod that is so many copies of the model."""
    mass = copies * frame.solid.mass
    product = lambda one, other: float(one.full @ (mass @ other.full))
    scaled = lambda shape, factor: Field(shape.full * factor, shape.along * factor, shape.across * factor)
    zeros, ones = numpy.zeros(len(frame.x)), numpy.ones(len(frame.x))
    along, across, place = frame.field(ones, zeros), frame.field(zeros, ones), frame.field(frame.x, frame.y)
    turned = lambda shape: frame.field(-shape.across, shape.along)

    grid = numpy.linspace(0.0, frame.length, 401)
    shapes: list[Field] = []
    deflections: list[BSpline] = []
    for _, shape in found.bending:
        largest = float(numpy.abs(sections.fit(shape.across)(grid)).max())
        shapes.append(scaled(shape, (1.0 if pins[0].rotation(shape) > 0.0 else -1.0) / largest))
        deflections.append(sections.fit(shapes[-1].across))
    end = pins[1].mean(1.0, 0.0)
    stretches = [scaled(shape, 1.0 / float(end @ shape.full)) for _, shape in found.axial]

    pairs = [(i, j) for i in range(len(shapes)) for j in range(i, len(shapes))]
    slopes = [deflection.derivative()(frame.x) for deflection in deflections]
    gammas = [sections.shortening(deflections[i], deflections[j]) for i, j in pairs]
    shortened = [frame.field(gamma(frame.x), 0.5 * frame.y * slopes[i] * slopes[j]) for gamma, (i, j) in zip(gammas, pairs)]

    functions = [place, *stretches, *shortened]
    second = numpy.array([[product(one, other) for other in functions] for one in functions])
    whole = product(along, along)
    mixture = [abs(product(place, shape)) / numpy.sqrt(second[0, 0] * product(shape, shape)) for shape in shapes]
    mixture.append(abs(product(across, place)) / numpy.sqrt(whole * second[0, 0]))
    if max(mixture) > ASYMMETRY:
        raise ModesError(f"the rod is not symmetric about its axis (by {max(mixture):.1%}); a table of modes has no place for that")
    # What is 0 by orthogonality comes as rounding.
    size = numpy.sqrt(numpy.outer(second.diagonal(), second.diagonal()))
    second = numpy.where(abs(second) < 1e-12 * size, 0.0, 0.5 * (second + second.T))
    return Table(
        length=frame.length,
        mass=whole,
        bending=tuple(
            Bending(
                frequency=frequency,
                mass=product(shape, shape),
                moment=product(across, shape),
                middle=float(deflection(0.5 * frame.length)),
                slope_start=pins[0].rotation(shape),
                slope_end=pins[1].rotation(shape),
            )
            for (frequency, _), shape, deflection in zip(found.bending, shapes, deflections)
        ),
        axial=tuple(
            Axial(frequency, mass=product(shape, shape), end=float(end @ shape.full))
            for (frequency, _), shape in zip(found.axial, stretches)
        ),
        shortening=numpy.array([float(gamma(frame.length)) for gamma in gammas]),
        first=numpy.array([product(along, function) for function in functions]),
        second=second,
        coupling=numpy.array([[product(turned(function), shape) for shape in shapes] for function in functions]).reshape(
            len(functions), len(shapes)
        ),
        left_out=tuple(found.other),
    )


def main() -> None:
    """`python -m slidercrank.modes rod.inp -o rod.toml`."""
    parser = argparse.ArgumentParser(prog="slidercrank.modes", description="a rod's table of modes from a deck of CalculiX")
    parser.add_argument("deck")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--bending", type=int, default=3)
    parser.add_argument("--axial", type=int, default=1)
    parser.add_argument("--bore", choices=["mean", "rigid"], default="mean")
    parser.add_argument("--whole", action="store_true", help="the deck holds the whole rod, not its half")
    parser.add_argument("--length", type=float, default=1.0, help="the deck's unit of length in metres")
    parser.add_argument("--mass", type=float, default=1.0, help="the deck's unit of mass in kilograms")
    asked = parser.parse_args()
    table = from_calculix(
        asked.deck,
        asked.bending,
        asked.axial,
        bore=asked.bore,
        symmetry=None if asked.whole else "SYMMETRY",
        length=asked.length,
        mass=asked.mass,
    )
    table.write(asked.output)
    hertz = lambda frequencies: ", ".join(f"{frequency / (2.0 * numpy.pi):.0f}" for frequency in frequencies) or "-"
    print(f"{table.length:.6g} m from pin to pin, {table.mass:.6g} kg")
    print(f"bending at {hertz(mode.frequency for mode in table.bending)} Hz")
    print(f"axial at {hertz(mode.frequency for mode in table.axial)} Hz")
    print(f"left out at {hertz(table.left_out)} Hz")


if __name__ == "__main__":
    main()
