"""Three masters for the same package: how an input goes on between two communication points.

    held          u(t) = y_n
    extrapolated  u(t) = y_n + (y_n − y_{n−1})/h·(t − t_n)
    iterated      u(t) = y_n + (y_{n+1} − y_n)/h·(t − t_n), with y_{n+1} found by rolling back and repeating

All units step side by side (Jacobi). A unit that takes slopes of inputs is handed value and slope,
another one the value that the line ends at. Through discrete variables no line is drawn.

The books of a coupling: what goes into the press through a torque or a force is its effort as
handed over times its own flow; by the other side's books it is that side's own effort times the
flow as handed over. Their difference, summed over the run, is energy that the coupling made or lost
(Sadjina, Kyllingstad, Skjong and Pedersen, Energy conservation and power bonds in co-simulations,
Engineering with Computers 33, 2017).
"""

from dataclasses import dataclass, field

import numpy

METHODS = ["held", "extrapolated", "iterated"]
# Share of its largest value so far, below which a change of a wire counts as none: the press's own tolerance.
CHANGE = 1e-6
ITERATIONS = 20


@dataclass
class Port:
    """Where power flows into the press."""

    effort: tuple  # the other side's output
    flow: tuple  # the press's output, handed to the other side
    displacement: str  # the press's output that the flow is the rate of
    sampled: bool  # whether the effort stays what it is within a step
    inside: float = 0.0  # [J] by the press's books
    outside: float = 0.0  # [J] by the other side's
    exchanged: float = 0.0  # [J] without signs


@dataclass
class Run:
    """Rows at the communication points, what was counted, and the books."""

    names: list
    rows: list = field(default_factory=list)
    passes: int = 0
    ports: dict = field(default_factory=dict)

    def table(self):
        return dict(zip(["time", *self.names], numpy.array(self.rows).T))


def ports():
    return {
        "torque": Port(("controller", "torque"), ("press", "crank.speed"), "crank.angle", True),
        "load": Port(("sheet", "force"), ("press", "slider.v"), "slider.x", False),
    }


class Master:
    """One run of a package; `also` are variables, each with its unit, to read beside the connectors."""

    def __init__(self, package, settings=(), tolerance=None, also=()):
        self.package = package
        self.units = package.start(settings, tolerance)
        self.outputs = {
            name: [own for own, kind in connectors if kind == "output"] + [own for unit, own in also if unit == name]
            for name, connectors in package.connectors.items()
        }
        self.references = {name: self.units[name].references(own) for name, own in self.outputs.items()}
        self.inputs = {name: [wire for wire in package.wires if wire.target[0] == name] for name in self.units}
        self.input_references = {
            name: self.units[name].references([wire.target[1] for wire in wires])
            for name, wires in self.inputs.items()
        }
        self.slope_references = {
            name: self.units[name].references([wire.target[1] for wire in wires if wire.continuous])
            for name, wires in self.inputs.items()
        }
        self.largest = {}

    def read(self):
        values = {}
        for name, unit in self.units.items():
            for own, value in zip(self.outputs[name], unit.fmu.getReal(self.references[name])):
                values[name, own] = value
        return values

    def write(self, now, end, step):
        """Hands over a line from the values `now` to those at the `end` of the step."""
        for name, wires in self.inputs.items():
            unit = self.units[name]
            late = not unit.takes_slopes
            values = [(end if late and wire.continuous else now)[wire.source] for wire in wires]
            unit.fmu.setReal(self.input_references[name], values)
            moving = [wire.source for wire in wires if wire.continuous]
            slopes = [(end[source] - now[source]) / step for source in moving]
            if unit.takes_slopes and any(slopes):
                unit.fmu.setRealInputDerivatives(self.slope_references[name], [1] * len(slopes), slopes)

    def attempt(self, now, end, time, step):
        self.write(now, end, step)
        for unit in self.units.values():
            unit.fmu.doStep(time, step, 0)
        return self.read()

    def save(self):
        return {name: unit.fmu.getFMUstate() for name, unit in self.units.items()}

    def roll_back(self, saved):
        for name, unit in self.units.items():
            unit.fmu.setFMUstate(saved[name])

    def forget(self, saved):
        for name, unit in self.units.items():
            unit.fmu.freeFMUstate(saved[name])

    def changed(self, one, other):
        """The largest change over a continuous wire, as a share of its largest value so far."""
        change = 0.0
        for source in (wire.source for wire in self.package.wires if wire.continuous):
            scale = self.largest[source] = max(self.largest.get(source, 0.0), abs(one[source]), abs(other[source]))
            change = max(change, abs(one[source] - other[source]) / scale if scale else 0.0)
        return change

    def iterate(self, now, guess, time, step, run):
        """Steps, rolls back and repeats until the end of the step is what it was taken to be."""
        saved = self.save()
        for _ in range(ITERATIONS):
            found = self.attempt(now, guess, time, step)
            run.passes += 1
            if self.changed(found, guess) <= CHANGE:
                self.forget(saved)
                return found, guess
            guess = found
            self.roll_back(saved)
        raise SystemExit(f"t = {time} s: {ITERATIONS} iterations were not enough")

    def run(self, method, step, stop, every=1):
        """Rows of all outputs at every `every`th communication point."""
        names = [f"{unit}.{own}" for unit, outputs in self.outputs.items() for own in outputs]
        run = Run(names, ports=ports())
        now = before = self.read()
        run.rows.append([0.0, *now.values()])
        time = 0.0
        for point in range(1, round(stop / step) + 1):
            line = {source: 2.0 * now[source] - before[source] for source in now}
            if method == "iterated":
                found, end = self.iterate(now, line, time, step, run)
            else:
                end = line if method == "extrapolated" else now
                found = self.attempt(now, end, time, step)
                run.passes += 1
            for port in run.ports.values():
                book(port, now, end, found, step)
            before, now = now, found
            time += step
            if point % every == 0:
                run.rows.append([time, *now.values()])
        for unit in self.units.values():
            unit.free()
        return run


def book(port, now, end, found, step):
    """One step: `end` is what the line that was handed over ends at, `found` what came of it."""
    moved = found["press", port.displacement] - now["press", port.displacement]
    if port.sampled:
        inside = now[port.effort] * moved
        outside = now[port.effort] * now[port.flow] * step
    else:
        # ∫ e·v over a line of effort, the velocity between its two ends a line too.
        rise = end[port.effort] - now[port.effort]
        inside = now[port.effort] * moved + rise * step * (now[port.flow] + 2.0 * found[port.flow]) / 6.0
        outside = 0.5 * (now[port.effort] * now[port.flow] + found[port.effort] * end[port.flow]) * step
    port.inside += inside
    port.outside += outside
    port.exchanged += abs(inside)
