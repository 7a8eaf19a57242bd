"""What a press shop measures: total stack-up clearance, and the parallelism of the slide.

`stack_up` pulls and pushes the slide at bottom dead centre, where crank and rod are in line, with a load that rises and
falls step by step and rests until nothing moves. Contacts give way, so what is found under load is more than the
clearance. A closed contact gives way like a power of its force, δ = b·F^q with q = 1/1.5 for Hertz, and that curve is
followed back to no load.

`parallelism` turns the crank under a load beside the pin and keeps the slide's tilt.
"""

from __future__ import annotations

import json
import math
import zipfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy
import pandas
from fmpy import read_model_description
from numpy.typing import NDArray

from .quantity import ANGLE, ROUNDING, passages
from .recipe import SPEED, RunError
from .simulation import simulate
from .study import Plan, plan
from .unit import Instance, Unit

JOINTS = ("A", "B", "C")
CLEARANCE = 2
"""`joint.J.model`: contact forces across a gap."""
HELD = 2
"""`drive.mode`: the crank turns at constant speed, here at none."""
STANDARD_GRAVITY = 9.81
"""[m/s²] For the size of loads."""
LEVELS = (2.0, 4.0, 8.0, 16.0, 32.0)
"""Loads unless they are given, in weights of crank, rod and slider."""
BOUNCES = 40.0
"""Length of a rest, in times that the slide takes through all clearances under the lowest load; at a restitution of 0.9
bounces last 19 of them."""
REST_POINTS = 20
"""Communication points of a rest, and of the ramp before it."""
CAUTION = 3.0
"""A found clearance is trusted to this many times what a load more or less changes: under Liu's law, which is no power,
the clearance is off by about twice that change."""
STILL = 1e-5
"""Share of the clearances that may still be moved through in the last quarter of a rest."""
DOUBLINGS = 4
"""How often rests are made twice as long until the slide is still in them."""
EXPONENTS = (0.25, 1.0)
"""Where q is looked for: contacts stiffen under load."""
NARROWINGS = 60
"""Steps of the search for q, each of which leaves 0.62 of the interval."""
SMOOTH = 3
"""`joint.J.friction.law`: hyperbolic tangent, which is viscous at low speed and leaves no force at rest."""
FRICTION = 0.1
"""Coefficient of that friction, which stands in for the scene's own."""
DRY = 1
"""`joint.J.lubrication`: none. Oil loses its viscosity: the load is so slow that the film is squeezed out."""
MOREAU = 8
"""`solver.method`: rigid contacts, whose friction stays that of the scene."""
OFFSET = "slider.load.offset"
"""[m] Parameter: the load's distance from the pin, across the guide."""
BOTTOM = "bottom dead centre"
"""[rad] Where a frame of strokes tells its bottom dead centre, in `attrs`."""
POINTS = 2000
"""Communication points of a turn."""
BUDGET = 600.0
"""[s of the wall] For one run."""

Values = NDArray[numpy.float64]


def stack_up(
    fmu: str | Path,
    loads: Sequence[float] | None = None,
    settings: Mapping[str, float] | None = None,
) -> pandas.DataFrame:
    """Total stack-up clearance at bottom dead centre: rows A, B, C and `total`, all in metres.

    `found` is the travel of a journal, or of the slider pin in the row `total`, between pull and push without load.
    `put in` is twice the radial clearance, 0 of an ideal joint, and their sum. `error` tells how sure the extrapolation
    is: three times the change of `found` if the lowest or the highest load is left out, and how far readings are off the
    curve. The row `total` is the pin's own travel, less what the contacts have given way.

    `loads` [N] are at least four, above the bodies' weights, which would otherwise open what the load closes. Without
    `loads` they are 2, 4, 8, 16 and 32 times the bodies' weights at 9.81 m/s². `settings` are parameters by name.
    """
    scene = Scene.of(fmu, settings or {})
    levels = scene.levels if loads is None else numpy.sort(numpy.asarray(loads, dtype=float))
    if len(numpy.unique(levels)) < 4:
        raise ValueError("the extrapolation needs four different loads")
    if not levels[0] > scene.weight:
        raise ValueError(f"loads must be above {scene.weight:.6g} N, the weight of crank, rod and slider")
    pull, push = (readings(fmu, scene, levels, sign) for sign in (1.0, -1.0))

    rows = {joint: (0.0, 0.0, 0.0) for joint in JOINTS}
    travel = numpy.array(pull["travel"] - push["travel"])
    unsure = 0.0
    for joint, clearance in scene.clearances.items():
        ways = [unloaded(way[f"{joint}.force"], way[f"{joint}.eccentricity"]) for way in (pull, push)]
        found, error = sum(way.begin for way in ways), sum(way.error for way in ways)
        rows[joint] = (found, 2.0 * clearance, error)
        travel -= sum(way.given for way in ways)
        unsure += error
    put_in = 2.0 * sum(scene.clearances.values())
    rows["total"] = (float(travel.mean()), put_in, unsure + float(numpy.ptp(travel)))

    frame = pandas.DataFrame.from_dict(rows, orient="index", columns=["found", "put in", "error"])
    frame.insert(2, "difference", frame["found"] - frame["put in"])
    return frame.rename_axis("joint")


def starts(fmu: str | Path, settings: Mapping[str, float]) -> Callable[[str], float]:
    """Start values by name: the settings', or the package's own."""
    known = {variable.name: variable for variable in read_model_description(str(fmu)).modelVariables}
    for name in settings:
        if name not in known:
            raise KeyError(f"{Path(fmu).name} has no variable `{name}`")
    return lambda name: float(settings.get(name, known[name].start))


def bottom_dead_centre(start: Callable[[str], float]) -> float:
    """[rad] The crank's angle where crank and rod are in line and the slider is farthest."""
    height, reach = start("guide.offset") - start("slider.centre.y"), start("crank.length") + start("rod.length")
    if abs(height) > reach:
        far = f"{abs(height):.6g} m from the crank's axis"
        raise ValueError(f"crank and rod, {reach:.6g} m long, do not reach the slider's pin, {far}")
    return math.asin(height / reach)


@dataclass(frozen=True)
class Scene:
    """What the measurement must know of a packaged scene."""

    settings: dict[str, float]
    """Start values of the measurement."""
    angle: float
    """[rad] Bottom dead centre: where crank and rod are in line."""
    clearances: dict[str, float]
    """[m] Radial, of the joints that have one."""
    mass: float
    """[kg] Of crank, rod and slider."""
    weight: float
    """[N] Of these in the scene's own gravity."""

    @classmethod
    def of(cls, fmu: str | Path, settings: Mapping[str, float]) -> Scene:
        start = starts(fmu, settings)
        angle = bottom_dead_centre(start)
        clearances = {j: start(f"joint.{j}.clearance") for j in JOINTS if start(f"joint.{j}.model") == CLEARANCE}
        mass = sum(start(f"{body}.mass") for body in ("crank", "rod", "slider"))
        held = {"drive.mode": HELD, SPEED: 0.0, "crank.angle_start": angle, OFFSET: 0.0}
        for joint, clearance in clearances.items():
            if start(f"joint.{joint}.lubrication") != DRY:
                held[f"joint.{joint}.viscosity"] = 0.0
            if start("solver.method") != MOREAU:
                # A journal rolls to and fro in its bearing like a pendulum as long as the clearance, pulled at by the
                # load F: damped critically, d = 2·√(F·m/c), by μ·F·v/v₁ if v₁ = μ/2·√(F·c/m).
                held[f"joint.{joint}.friction.law"] = SMOOTH
                held[f"joint.{joint}.friction.coefficient"] = FRICTION
                held[f"joint.{joint}.friction.v1"] = FRICTION / 2.0 * math.sqrt(LEVELS[0] * STANDARD_GRAVITY * clearance)
        return cls({**settings, **held}, angle, clearances, mass, mass * abs(start("gravity")))

    @property
    def levels(self) -> Values:
        """[N] Loads that close all clearances, with a share for weights."""
        return numpy.array(LEVELS) * max(self.mass * STANDARD_GRAVITY, self.weight)


def readings(fmu: str | Path, scene: Scene, levels: Values, sign: float) -> pandas.DataFrame:
    """One direction: the load rises level by level and falls again; a reading at the end of each rest."""
    steps = [*levels, *levels[-2::-1]]
    clearance = sum(scene.clearances.values())
    # s = F/m·t²/2 through all clearances, 2·Σc.
    across = math.sqrt(2.0 * 2.0 * max(clearance, 1e-6) * scene.mass / (levels[0] - scene.weight))
    for doubling in range(DOUBLINGS + 1):
        rest = BOUNCES * across * 2.0**doubling
        # From its level's ramp on a load rests; the first has no ramp.
        times = [time for step in range(len(steps)) for time in (2 * step * rest, (2 * step + 1) * rest)]
        load = [sign * level for level in steps for _ in range(2)]
        inputs = pandas.DataFrame({"crank.torque": 0.0, "slider.load": load}, index=times)
        names = ["slider.x", "slider.y", "rod.stretch"]
        for joint in scene.clearances:
            names += [f"joint.{joint}.{vector}.{axis}" for vector in ("eccentricity", "force") for axis in "xy"]
        run = simulate(fmu, times[-1], rest / REST_POINTS, scene.settings, inputs, names)
        # Along crank and rod, which are in line.
        along = run["slider.x"] * math.cos(scene.angle) + run["slider.y"] * math.sin(scene.angle)
        read = pandas.DataFrame({"travel": along - run["rod.stretch"]})
        for joint in scene.clearances:
            for vector in ("eccentricity", "force"):
                read[f"{joint}.{vector}"] = numpy.hypot(*(run[f"joint.{joint}.{vector}.{axis}"] for axis in "xy"))
        ends = [run.index.get_indexer([time], method="nearest")[0] for time in times[1::2]]
        quarter = REST_POINTS // 4
        moved = max(numpy.ptp(run["slider.x"].to_numpy()[end - quarter : end + 1]) for end in ends)
        if moved <= STILL * max(clearance, 1e-6):
            return read.iloc[ends]
    raise RunError(f"the slide still moves through {moved:.3g} m in {rest / 4.0:.3g} s of a constant load")


@dataclass(frozen=True)
class Curve:
    """A curve l = l₀ + b·F^q through readings."""

    begin: float
    """[m] l₀, without load."""
    error: float
    """[m] Of l₀."""
    given: Values
    """[m] b·F^q of each reading: how far the contact has given way."""


def unloaded(forces: pandas.Series, lengths: pandas.Series) -> Curve:
    """The curve through readings of a load that rises and falls: the highest is the middle one, the lowest the outer ones."""
    under, at = forces.to_numpy(), lengths.to_numpy()
    middle = len(at) // 2
    begin, fitted = curve(under, at)
    without = [curve(under[1:-1], at[1:-1])[0], curve(numpy.delete(under, middle), numpy.delete(at, middle))[0]]
    changes = max(abs(begin - other) for other in without)
    off = float(numpy.abs(at - fitted).max())
    return Curve(begin, CAUTION * changes + off, fitted - begin)


def curve(forces: Values, lengths: Values) -> tuple[float, Values]:
    """l₀ of the curve l = l₀ + b·F^q by least squares, and the curve at the readings; q by golden section."""
    relative = forces / forces.max()

    def straight(exponent: float) -> tuple[float, Values]:
        terms = numpy.column_stack([numpy.ones_like(relative), relative**exponent])
        found = numpy.linalg.lstsq(terms, lengths, rcond=None)[0]
        return float(found[0]), terms @ found

    golden = (math.sqrt(5.0) - 1.0) / 2.0
    low, high = EXPONENTS
    for _ in range(NARROWINGS):
        left, right = high - golden * (high - low), low + golden * (high - low)
        errors = [float(numpy.sum((lengths - straight(exponent)[1]) ** 2)) for exponent in (left, right)]
        low, high = (low, right) if errors[0] <= errors[1] else (left, high)
    return straight((low + high) / 2.0)


def parallelism(
    fmu: str | Path,
    offsets: Sequence[float],
    load: float | None = None,
    turns: float = 3.0,
    settings: Mapping[str, float] | None = None,
) -> pandas.DataFrame:
    """The slide's tilt [rad] over its last whole turn, with the load at each of the `offsets` [m] across the guide.

    The index is (`offset`, `crank.angle`); columns are `slider.angle`, `slider.x` and
    `joint.T.moment`. The load is the scene's own over the crank's turn, or a constant `load` [N].
    `settings` are further parameters by name.
    """
    if turns < 1.0:
        raise ValueError("a stroke is a turn")
    kept = ["slider.angle", "slider.x", "joint.T.moment"]
    start = starts(fmu, settings or {})
    planned = over_offsets(fmu, offsets, turns, start(SPEED))
    given = {**(settings or {}), **({} if load is None else {"slider.load": load})}
    recipe = planned.recipe.holding(given)
    strokes = {}
    with TemporaryDirectory() as folder:
        unit = Unit(Path(fmu), Path(folder))
        for offset in planned.runs[OFFSET].tolist():
            own = {**given, SPEED: start(SPEED), OFFSET: offset}
            with Instance(unit, recipe, own, [ANGLE, *kept]) as instance:
                instance.march(recipe.latest(own), BUDGET)
                columns = instance.columns()
            last = numpy.abs(columns[ANGLE] - columns[ANGLE][-1]) <= math.tau * (1.0 + ROUNDING)
            angles = pandas.Index(columns[ANGLE][last], name=ANGLE)
            strokes[offset] = pandas.DataFrame({name: columns[name][last] for name in kept}, index=angles)
    frame = pandas.concat(strokes, names=["offset"])
    frame.attrs[BOTTOM] = bottom_dead_centre(start)
    return frame


def over_offsets(fmu: str | Path, offsets: Sequence[float], turns: float, speed: float) -> Plan:
    """A run for each offset, with the inputs of the scene that is in the package."""
    if not abs(speed) > 0.0:
        raise ValueError("the crank does not turn: crank.speed_start is 0 rad/s")
    with TemporaryDirectory() as folder:
        scene, file = Path(folder) / "scene.toml", Path(folder) / "parallelism.toml"
        with zipfile.ZipFile(fmu) as package:
            scene.write_bytes(package.read("documentation/scene.toml"))
        told = [
            'name = "parallelism"',
            f"scene = {json.dumps(str(scene))}",
            "[run]",
            f"turns = {float(turns)!r}",
            f"step = {math.tau / abs(speed) / POINTS!r}",
            "[grid]",
            f'"{OFFSET}" = {[float(offset) for offset in offsets]!r}',
            "[keep]",
            'tilt = { of = "slider.angle", reduce = "peak", at = 0 }',
        ]
        file.write_text("\n".join(told), encoding="utf-8")
        return plan(file)


def at_bottom_dead_centre(strokes: pandas.DataFrame) -> pandas.DataFrame:
    """What `parallelism` found, an offset a row: tilt [rad] at bottom dead centre, and the largest of the stroke.

    `tilt` is that at its end if the stroke begins and ends there. `largest` has its sign; `angle` [rad] in 0 … 2π is
    where the crank is then.
    """
    rows = {}
    for offset, stroke in strokes.groupby(level="offset"):
        angles = stroke.index.get_level_values(ANGLE).to_numpy()
        tilts = stroke["slider.angle"].to_numpy()
        passed = passages(angles, tilts, strokes.attrs.get(BOTTOM, 0.0))
        largest = int(numpy.abs(tilts).argmax())
        at = passed[numpy.abs(passed).argmax()] if len(passed) else math.nan
        rows[offset] = (at, tilts[largest], angles[largest] % math.tau)
    return pandas.DataFrame.from_dict(rows, orient="index", columns=["tilt", "largest", "angle"]).rename_axis("offset")
