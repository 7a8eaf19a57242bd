"""The rigid mechanism in heyoka: Taylor series of the equations of motion, compiled by LLVM, contacts located as events.

The equations are written here as expressions, for any choice of joints: coordinates of the open chains that the
clearances leave, their mass matrix eliminated symbolically. There is one compiled system for each set of closed
contacts that occurs, compiled when it first does and kept. A contact's force is piecewise smooth: damping has a clip
and a limit, friction a ramp. Within a piece it is K d^p (d0 + d1 d') along the normal and mu (f0 + f1 v) of that across,
with d0, d1, f0, f1 in the system's parameters. An event ends the piece; only then Python is called.

    python heyoka_mechanism.py JOB compiled|whole

The method says which CPU time counts: that inside heyoka's `propagate_until`, or all of it. Neither has compilation.
"""

import math
import time

import heyoka as hy
import numpy as np

import job as jobs

CLEARANCE, SPEED_DRIVE, NO_FRICTION, AMBROSIO = 2, 2, 1, 2
SHALLOWEST = 1e-14  # [m] A contact begins here: at 0 the power of the penetration has no Taylor series.
EDGE = 1e-12  # [m/s] So much beyond the limit of the damping: a touch begins there, and must be on one side.
OUTSIDE = 1e-9  # of a bound
MOST_EVENTS = 100_000
BODIES = {"A": ("ground", "crank"), "B": ("rod", "crank"), "C": ("rod", "slider")}  # Bearing and journal.
PINS = tuple(BODIES)
SPENT = {"compiled code": 0.0, "compilation": 0.0}  # [s] CPU time, and time on the clock.
LAWS = {
    1: lambda e: 0.0,
    2: lambda e: 1.5 * (1 - e),
    3: lambda e: 6 * (1 - e) / ((2 * e - 1) ** 2 + 3),
    4: lambda e: 0.75 * (1 - e),
    5: lambda e: 0.75 * (1 - e**2),
    6: lambda e: (1 - e**2) / e,
    8: lambda e: 1.6 * (1 - e) / e,
    9: lambda e: 1.5 * (1 - e) / e,
    10: lambda e: 0.75 * (1 - e**2) * math.exp(2 * (1 - e)),
    11: lambda e: 1.5 * (1 - e) * (11 - e) / (1 + 9 * e),
}  # Factor of the hysteresis damping by the law's number in the interface, for a restitution e; not the implicit law.


def unit(angle):
    return np.array([math.cos(angle), math.sin(angle)])


def across(v):
    return np.array([-v[1], v[0]])


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def total(terms):
    """Their sum, of numbers and expressions, without those that are 0."""
    terms = [x for x in terms if not nothing(x)]
    return hy.sum([hy.expression(x) if isinstance(x, float) else x for x in terms]) if terms else 0.0


def nothing(x):
    return isinstance(x, float) and x == 0.0


def times(number, x):
    return 0.0 if number == 0.0 else number * x


class Place:
    """A point: a fixed place, plus coordinates along the axes, plus vectors that turn with bodies."""

    def __init__(self, fixed=(0.0, 0.0), coordinates=(), arms=None):
        self.fixed, self.coordinates = np.array(fixed, float), dict(coordinates)
        self.arms = {body: arm for body, arm in (arms or {}).items() if np.any(arm != 0.0)}

    def plus(self, body, arm):
        return Place(self.fixed, self.coordinates, self.arms | {body: self.arms.get(body, 0.0) + np.array(arm)})


class Mechanism:
    """Coordinates, and places as expressions of them."""

    def __init__(self, job):
        self.a = a = job["parameters"]
        self.inputs = job["inputs"]
        self.clear = {joint: a[f"joint.{joint}.model"] == CLEARANCE for joint in "ABCT"}
        self.loop = not any(self.clear.values())
        self.driven = a["drive.mode"] == SPEED_DRIVE
        self.q, self.u, self.start, self.start_rates = [], [], [], []
        self.extra = []  # Further states: the rate and the value at the start of each.
        self.unit = {"ground": (1.0, 0.0), "slider": (1.0, 0.0)}
        self.spin = {"ground": 0.0, "slider": 0.0}
        self.index = {}  # Coordinate of a body's angle.
        self.begin()
        self.place()

    def begin(self):
        """The closed loop at the start, as numbers: angles and places, and rates with all eccentricities at rest."""
        a, clear = self.a, self.clear
        r, l, th, w = a["crank.length"], a["rod.length"], a["crank.angle_start"], a["crank.speed_start"]
        offset = {joint: np.zeros(2) for joint in PINS}
        for joint in PINS:
            if clear[joint]:
                offset[joint] = np.array([a[f"joint.{joint}.eccentricity_start.{axis}"] for axis in "xy"])
        self.rail = a["guide.offset"] - a["slider.centre.y"]
        height = self.rail + (a["joint.T.offset_start"] if clear["T"] else 0.0)
        main = offset["A"]
        big = main + r * unit(th) - offset["B"]
        rod = math.asin((height - offset["C"][1] - big[1]) / l)
        turn = -r * w * math.cos(th) / (l * math.cos(rod))
        pin = big + l * unit(rod) + offset["C"]
        rate = r * w * across(unit(th))
        along = rate + l * turn * across(unit(rod))
        self.at = {"crank": (th, w, main, np.zeros(2)), "rod": (rod, turn, big, rate), "slider": (0.0, 0.0, pin, along)}

    def coordinate(self, name, value, rate):
        q, u = hy.make_vars(name, "rate_of_" + name)
        self.q.append(q)
        self.u.append(u)
        self.start.append(value)
        self.start_rates.append(rate)
        return len(self.q) - 1

    def turns(self, body):
        """Makes the angle of a body a coordinate."""
        i = self.index[body] = self.coordinate(f"angle_of_{body}", *self.at[body][:2])
        self.unit[body], self.spin[body] = (hy.cos(self.q[i]), hy.sin(self.q[i])), self.u[i]

    def drive(self):
        """Cosine and sine of a driven crank's angle are states, of the cheapest equations that a series can have."""
        angle, speed, *_ = self.at["crank"]
        c, s = self.unit["crank"] = hy.make_vars("cosine", "sine")
        self.spin["crank"] = speed
        self.extra = [(c, -speed * s, math.cos(angle)), (s, speed * c, math.sin(angle))]

    def close(self):
        """The rod of the closed loop follows the crank."""
        r, l = self.a["crank.length"], self.a["rod.length"]
        c, s = self.unit["crank"]
        sine = (self.rail - r * s) / l
        cosine = hy.sqrt(1.0 - sine * sine)
        self.ratio = -(r / l) * c / cosine
        self.unit["rod"], self.spin["rod"] = (cosine, sine), self.ratio * self.spin["crank"]
        self.index["rod"] = 1  # A row of the mass matrix, which `projected` takes away.

    def free(self, body):
        """Reference point of a body whose centre of mass has coordinates, which makes its mass matrix diagonal."""
        angle, rate, place, velocity = self.at[body]
        centre = np.array([self.a[f"{body}.com.x"], self.a[f"{body}.com.y"]])
        c, s = unit(angle)
        arm = np.array([c * centre[0] - s * centre[1], s * centre[0] + c * centre[1]])
        start, rates = place + arm, velocity + rate * across(arm)
        own = {self.coordinate(f"{'xy'[i]}_of_{body}", start[i], rates[i]): i for i in (0, 1)}
        return Place((0.0, 0.0), own, {body: -centre})

    def place(self):
        a, clear = self.a, self.clear
        crank, rod = np.array([a["crank.length"], 0.0]), np.array([a["rod.length"], 0.0])
        self.drive() if self.driven else self.turns("crank")
        self.close() if self.loop else self.turns("rod")
        if clear["T"]:
            self.turns("slider")
        rail = not clear["C"] and not clear["T"] and (clear["A"] or clear["B"])
        main = Place()
        if clear["A"] and (clear["B"] or not rail):
            main = self.free("crank")
        if rail:  # The chain begins at the slider.
            pin = self.on_rail()
            small, big = pin, pin.plus("rod", -rod)
            if not clear["B"]:
                main = big.plus("crank", -crank)
        else:
            big = self.free("rod") if clear["B"] else main.plus("crank", crank)
            small = pin = big.plus("rod", rod)
            if clear["C"]:
                pin = self.free("slider") if clear["T"] else self.on_rail()
        self.pin = pin
        self.pins = {"A": (Place(), main), "B": (big, main.plus("crank", crank)), "C": (small, pin)}
        reference = {"crank": main, "rod": big, "slider": pin}
        self.centres = {b: p.plus(b, [a[f"{b}.com.x"], a[f"{b}.com.y"]]) for b, p in reference.items()}

    def on_rail(self):
        _, _, place, velocity = self.at["slider"]
        return Place((0.0, self.rail), {self.coordinate("x_of_slider", place[0], velocity[0]): 0})

    def turned(self, body, arm):
        c, s = self.unit[body]
        x, y = map(float, arm)
        return np.array([total([times(x, c), times(-y, s)]), total([times(x, s), times(y, c)])])

    def vector(self, place):
        parts = [self.turned(body, arm) for body, arm in place.arms.items()]
        own = [[self.q[i] for i, axis in place.coordinates.items() if axis == k] for k in (0, 1)]
        return np.array([total([float(place.fixed[k]), *own[k], *(part[k] for part in parts)]) for k in (0, 1)])

    def velocity(self, place):
        parts = [self.spin[body] * self.turned(body, across(arm)) for body, arm in place.arms.items() if body in self.moves()]
        own = [[self.u[i] for i, axis in place.coordinates.items() if axis == k] for k in (0, 1)]
        return np.array([total([*own[k], *(part[k] for part in parts)]) for k in (0, 1)])

    def moves(self):
        return [body for body, spin in self.spin.items() if not nothing(spin)]

    def difference(self, one, other):
        """From `other` to `one`; what they share cancels."""
        coordinates = {i: axis for i, axis in one.coordinates.items() if i not in other.coordinates}
        gone = {i: axis for i, axis in other.coordinates.items() if i not in one.coordinates}
        bodies = one.arms.keys() | other.arms.keys()
        arms = {body: one.arms.get(body, np.zeros(2)) - other.arms.get(body, np.zeros(2)) for body in sorted(bodies)}
        shared, lost = Place(one.fixed - other.fixed, coordinates, arms), Place(coordinates=gone)
        pairs = (self.vector, self.velocity)
        return [np.array([total([x, times(-1.0, y)]) for x, y in zip(f(shared), f(lost))]) for f in pairs]

    def add(self, forces, place, force):
        """Adds what a force at a place does to each coordinate."""
        for i, axis in place.coordinates.items():
            forces[i].append(force[axis])
        for body, arm in place.arms.items():
            moment = cross(self.turned(body, arm), force)
            self.twist(forces, body, moment)

    def twist(self, forces, body, moment):
        """The same of a moment."""
        if body in self.index:
            forces[self.index[body]].append(moment)

    def difference_angle(self, one, other):
        """Cosine and sine of the angle from `one` to `other`."""
        if {one, other} <= self.index.keys() and not self.loop:
            angle = self.q[self.index[other]] - self.q[self.index[one]]
            return hy.cos(angle), hy.sin(angle)
        (c, s), (cosine, sine) = self.unit[one], self.unit[other]
        return c * cosine + s * sine, c * sine - s * cosine

    def masses(self):
        """Mass matrix, and the forces of centrifugal accelerations."""
        index = self.index
        n = max([len(self.q), *(i + 1 for i in index.values())])
        mass = [[[] for _ in range(n)] for _ in range(n)]
        forces = [[] for _ in range(n)]
        level, products = np.zeros(n), {}
        for body, centre in self.centres.items():
            m = self.a[f"{body}.mass"]
            for i in centre.coordinates:
                level[i] += m
            if body in index:
                level[index[body]] += self.a[f"{body}.inertia"]
            for one, a in centre.arms.items():
                if one in index:
                    level[index[one]] += m * float(a @ a)
                for i, axis in centre.coordinates.items():
                    products[i, axis, one] = products.get((i, axis, one), 0.0) + m * a
                for other, b in centre.arms.items():
                    if one != other:
                        pair = m * np.array([a @ b, cross(a, b)])
                        products[one, other] = products.get((one, other), 0.0) + pair
        for i in range(n):
            mass[i][i].append(float(level[i]))
        for key, product in products.items():
            *one, other = key
            square = self.spin[other] * self.spin[other]
            if len(one) == 2:  # A coordinate along an axis, and a body that turns.
                i, axis = one
                if other in index:
                    j = index[other]
                    entry = self.turned(other, across(product))[axis]
                    mass[i][j].append(entry)
                    mass[j][i].append(entry)
                if other in self.moves():
                    forces[i].append(square * self.turned(other, product)[axis])
                continue
            if one[0] not in index:
                continue
            i, (along, off) = index[one[0]], map(float, product)
            cosine, sine = self.difference_angle(one[0], other)
            if other in index:
                mass[i][index[other]].append(total([times(along, cosine), times(-off, sine)]))
            if other in self.moves():
                forces[i].append(square * total([times(off, cosine), times(along, sine)]))
        return mass, forces

    def accelerations(self, loads):
        """Second derivatives of the coordinates; `loads(forces)` adds the contacts' forces."""
        mass, forces = self.masses()
        angle = self.a["gravity.angle"]
        # The cosine of -pi/2 is rounded.
        fall = self.a["gravity"] * np.array([0.0, -1.0] if angle == -math.pi / 2 else [math.cos(angle), math.sin(angle)])
        for body, centre in self.centres.items():
            self.add(forces, centre, self.a[f"{body}.mass"] * fall)
        self.add(forces, self.pin, np.array([self.inputs["slider_load"], 0.0]))
        self.twist(forces, "crank", self.inputs["crank_torque"])
        for joint, (bearing, journal) in BODIES.items():
            friction = times(-self.a[f"joint.{joint}.damping"], self.spin[journal] - self.spin[bearing])
            self.twist(forces, journal, friction)
            self.twist(forces, bearing, times(-1.0, friction))
        rubbing = times(-self.a["joint.T.damping"], self.velocity(self.pin)[0])
        self.add(forces, self.pin, np.array([rubbing, 0.0]))
        loads(forces)
        mass, forces = [[total(entry) for entry in row] for row in mass], [total(terms) for terms in forces]
        return [self.projected(mass, forces)] if self.loop else eliminate(mass, forces)

    def projected(self, mass, forces):
        """The crank's acceleration in the closed loop, where that of the rod is ratio times it plus `rest`."""
        (crank, couple), (_, rod) = mass
        r, l, k = self.a["crank.length"], self.a["rod.length"], self.ratio
        w, turn, cosine = self.spin["crank"], self.spin["rod"], self.unit["rod"][0]
        rest = (l * self.unit["rod"][1] * turn * turn + r * self.unit["crank"][1] * w * w) / (l * cosine)
        force = total([forces[0], k * forces[1] if not nothing(forces[1]) else 0.0, -(couple + k * rod) * rest])
        return force / (crank + 2.0 * k * couple + k * k * rod)

    def measures(self):
        """What the error is measured in."""
        a, found = self.a, []
        for joint, (bearing, journal) in self.pins.items():
            if self.clear[joint]:
                found.extend(self.difference(journal, bearing)[0] / a[f"joint.{joint}.clearance"])
        if self.clear["T"]:
            gap, tilt = a["joint.T.clearance"], self.q[self.index["slider"]]
            found += [self.vector(self.pin)[1] / gap, 0.5 * a["slider.length"] * tilt / gap]
        rod = hy.asin(self.unit["rod"][1])
        return found or [self.q[0], rod, self.vector(self.pin)[0] / a["crank.length"]]


def eliminate(matrix, right):
    """Gauss's elimination of a symmetric matrix of expressions; zeros cost nothing."""
    n = len(right)
    for k in range(n):
        for i in range(k + 1, n):
            if nothing(matrix[i][k]):
                continue
            factor = matrix[i][k] / matrix[k][k]
            for j in range(k + 1, n):
                if not nothing(matrix[k][j]):
                    matrix[i][j] = matrix[i][j] - factor * matrix[k][j]
            right[i] = right[i] - factor * right[k]
    solved = [0.0] * n
    for i in reversed(range(n)):
        terms = [-matrix[i][j] * solved[j] for j in range(i + 1, n) if not nothing(matrix[i][j])]
        solved[i] = total([right[i], *terms]) / matrix[i][i]
    return solved


class Contact:
    """One possible touch: its law's numbers, and expressions of penetration, its rate and the sliding speed."""

    def __init__(self, a, joint, radii):
        value = lambda name: a[f"joint.{joint}.{name}"]
        self.exponent, self.floor, self.limit = value("exponent"), value("speed_floor"), value("ratio_limit")
        self.chi = LAWS[int(value("law"))](value("restitution"))
        compliance = sum((1 - value(f"poisson.{part}") ** 2) / value(f"young.{part}") for part in ("bearing", "journal"))
        self.stiffness = value("stiffness") or 4 / (3 * compliance) * math.sqrt(radii)
        self.friction = value("friction.coefficient") if value("friction.law") == AMBROSIO else 0.0
        self.v0, self.v1 = value("friction.v0"), value("friction.v1")

    def damping_piece(self, rate, approach):
        """d0, d1 and the bounds of the penetration's rate between which they hold."""
        if self.chi == 0.0:
            return 1.0, 0.0, -math.inf, math.inf
        clip = -approach / self.chi
        top = self.limit * approach + EDGE if self.limit > 0 else math.inf
        if rate < clip:
            return 0.0, 0.0, -math.inf, clip
        if rate > top:
            return 1 + self.chi * self.limit, 0.0, top, math.inf
        return 1.0, self.chi / approach, clip, top

    def friction_piece(self, slip):
        """f0, f1 and the bounds of the sliding speed between which they hold."""
        v0, v1, slope, sign = self.v0, self.v1, 1 / (self.v1 - self.v0), math.copysign(1.0, slip)
        if abs(slip) >= v1:
            return (sign, 0.0, v1, math.inf) if slip > 0 else (sign, 0.0, -math.inf, -v1)
        if v0 == 0.0:
            return 0.0, slope, -v1, v1
        if abs(slip) < v0:
            return 0.0, 0.0, -v0, v0
        return (-sign * v0 * slope, slope, *((v0, v1) if slip > 0 else (-v1, -v0)))


class Closed:
    """A contact that is closed, and the pieces of its laws that hold."""

    def __init__(self, contact, depth, rate, slip):
        self.contact, self.approach = contact, max(contact.floor, rate)
        # An event is as exact as the tolerance: the shift makes the penetration begin where it should.
        self.shift = max(0.0, SHALLOWEST - depth)
        self.damping = contact.damping_piece(rate, self.approach)
        self.friction = contact.friction_piece(slip)
        self.changed = {}  # [s] When a law's piece last did.

    def follow(self, rate, slip, law, t):
        """Changes the piece of `law` beyond the bound that was met, and any piece that is past its bounds: the event of
        another contact at the same time may have hidden its own. No piece changes twice at one time for that reason."""
        past = lambda name, value, piece: not piece[2] <= value <= piece[3] and self.changed.get(name) != t
        if law == "damping" or past("damping", rate, self.damping):
            self.damping = self.contact.damping_piece(beyond(rate, *self.damping[2:]), self.approach)
            self.changed["damping"] = t
        if law == "friction" or past("friction", slip, self.friction):
            self.friction = self.contact.friction_piece(beyond(slip, *self.friction[2:]))
            self.changed["friction"] = t

    def parameters(self):
        (d0, d1, *rates), (f0, f1, *slips) = self.damping, self.friction
        return [d0, d1, f0, f1, *inside(*rates), *inside(*slips), self.shift]


def beyond(value, low, high):
    """Just outside of the bound that is nearer."""
    return low - OUTSIDE * abs(low) if value - low < high - value else high + OUTSIDE * abs(high)


def inside(low, high):
    """Coefficients of 1, v, v^2 of a function that is positive between the bounds."""
    if math.isinf(low) and math.isinf(high):
        return 1.0, 0.0, 0.0
    if math.isinf(low):
        return high, -1.0, 0.0
    if math.isinf(high):
        return -low, 1.0, 0.0
    return -low * high, low + high, -1.0


class PinContact(Contact):
    """A journal in its bearing."""

    def __init__(self, m, joint):
        self.outer, self.c = m.a[f"joint.{joint}.radius"], m.a[f"joint.{joint}.clearance"]
        super().__init__(m.a, joint, self.outer * (self.outer - self.c) / self.c)
        self.bodies, (self.bearing, self.journal) = BODIES[joint], m.pins[joint]
        self.e, rates = m.difference(self.journal, self.bearing)
        square = self.e[0] * self.e[0] + self.e[1] * self.e[1]
        self.distance = hy.sqrt(square)
        self.over = 1.0 / self.distance
        self.depth = self.distance - self.c
        # As the depth, but smooth where the journal is centred.
        limit = self.c + SHALLOWEST
        self.touch = (square - limit * limit) / (2 * self.c)
        self.rate = (self.e[0] * rates[0] + self.e[1] * rates[1]) * self.over
        rolling, turning = (m.spin[body] for body in self.bodies)
        rolls = [times(-self.outer, rolling), 0.0 if nothing(turning) else (self.outer - self.distance) * turning]
        self.slip = total([cross(self.e, rates) * self.over, *rolls])

    def load(self, m, forces, push, friction):
        normal = push * self.over
        force = [-normal * x for x in self.e]
        (bearing, journal) = self.bodies
        if self.friction:
            rub = friction * self.over
            force = [force[0] + rub * self.e[1], force[1] - rub * self.e[0]]
            m.twist(forces, journal, -(self.outer - self.distance) * friction)
            m.twist(forces, bearing, self.outer * friction)
        m.add(forces, self.journal, force)
        m.add(forces, self.bearing, [-x for x in force])


class CornerContact(Contact):
    """A corner of the slider against the line on its side; `end` and `side` are its signs."""

    def __init__(self, m, end, side):
        a = m.a
        super().__init__(a, "T", a["joint.T.corner_radius"])
        half, high = 0.5 * a["slider.length"], 0.5 * a["slider.height"]
        self.side = side
        self.corner = m.pin.plus("slider", [a["slider.centre.x"] + end * half, a["slider.centre.y"] + side * high])
        wall = side * a["guide.offset"] + high + a["joint.T.clearance"]
        self.depth = side * m.vector(self.corner)[1] - wall
        self.touch = self.depth - SHALLOWEST
        self.slip, climb = m.velocity(self.corner)
        self.rate = side * climb

    def load(self, m, forces, push, friction):
        m.add(forces, self.corner, [-friction if self.friction else 0.0, -self.side * push])


def contacts(m):
    """All contacts of the mechanism."""
    found = [PinContact(m, joint) for joint in PINS if m.clear[joint]]
    corners = [(end, side) for side in (1.0, -1.0) for end in (-1.0, 1.0)]
    return found + [CornerContact(m, *signs) for signs in corners if m.clear["T"]]


class Compiled:
    """Compiled systems by the set of closed contacts; `watched` are the numbers of each contact that `look` tells."""

    def __init__(self, job, watched):
        self.m = m = Mechanism(job)
        self.contacts = contacts(m)
        self.kept = {}
        self.variables = [*m.q, *m.u, *(variable for variable, _, _ in m.extra)]
        self.start = np.array([*m.start, *m.start_rates, *(value for _, _, value in m.extra)])
        numbers = [hy.expression(0.0) + getattr(c, name) for c in self.contacts for name in watched]
        self.watch = hy.cfunc(numbers, self.variables) if numbers else None
        self.measure = hy.cfunc(m.measures(), self.variables)

    def look(self, state):
        """A row for each contact."""
        return self.watch(state).reshape(len(self.contacts), -1) if self.contacts else np.zeros((0, 3))

    def system(self, closed):
        if closed not in self.kept:
            before = time.monotonic()
            self.kept[closed] = self.make(closed)
            SPENT["compilation"] += time.monotonic() - before
        return self.kept[closed]


PER_CONTACT = 11  # d0 d1 f0 f1, the coefficients of the two events, and the shift of the penetration


class Systems(Compiled):
    """Integrators of one tolerance."""

    def __init__(self, job, tolerance):
        super().__init__(job, ["depth", "rate", "slip"])
        self.tolerance = tolerance

    def make(self, closed):
        m, pushes, watched, events = self.m, [], [], []
        rising, falling = hy.event_direction.positive, hy.event_direction.negative
        for i, contact in enumerate(self.contacts):
            if i not in closed:
                watched.append(hy.t_event(contact.touch, direction=rising))
                events.append((i, "touch"))
                continue
            first = PER_CONTACT * sorted(closed).index(i)
            p = [hy.par[first + k] for k in range(PER_CONTACT)]
            depth = contact.depth + p[10]
            push = contact.stiffness * depth**contact.exponent * (p[0] + p[1] * contact.rate)
            pushes.append((contact, push, contact.friction * push * (p[2] + p[3] * contact.slip)))
            watched.append(hy.t_event(depth - SHALLOWEST, direction=falling))
            events.append((i, "part"))
            if contact.chi:
                within = p[4] + p[5] * contact.rate + p[6] * contact.rate * contact.rate
                watched.append(hy.t_event(within, direction=falling))
                events.append((i, "damping"))
            if contact.friction:
                within = p[7] + p[8] * contact.slip + p[9] * contact.slip * contact.slip
                watched.append(hy.t_event(within, direction=falling))
                events.append((i, "friction"))

        def loads(forces):
            for contact, push, friction in pushes:
                contact.load(m, forces, push, friction)

        accelerations = [hy.expression(0.0) + x for x in m.accelerations(loads)]
        rates = [*zip(m.q, m.u), *zip(m.u, accelerations), *((variable, rate) for variable, rate, _ in m.extra)]
        ta = hy.taylor_adaptive(rates, self.start, tol=self.tolerance, t_events=watched, fast_math=True)
        return ta, events


class March:
    """One run."""

    def __init__(self, systems, span):
        self.systems, self.span = systems, span

    def enter(self, state, t):
        """The system of the contacts that are closed, with their pieces."""
        ta, self.events = self.systems.system(frozenset(self.closed))
        ta.time = t
        ta.state[:] = state
        if self.events:
            ta.reset_cooldowns()
        for k, i in enumerate(sorted(self.closed)):
            ta.pars[PER_CONTACT * k : PER_CONTACT * (k + 1)] = self.closed[i].parameters()
        return ta

    def happen(self, event, state, t):
        """Closes and opens contacts after an event: its own, and all that are past it at the same time."""
        now = self.systems.look(state)
        for i, contact in enumerate(self.systems.contacts):
            depth, rate, slip = now[i]
            if i in self.closed:
                if event == (i, "part") or (depth + self.closed[i].shift < SHALLOWEST and rate < 0):
                    del self.closed[i]
                else:
                    self.closed[i].follow(rate, slip, event[1] if event[0] == i else "", t)
            elif event == (i, "touch") or (depth > SHALLOWEST and rate > 0):
                self.closed[i] = Closed(contact, depth, rate, slip)

    def run(self, points):
        systems = self.systems
        state, t = systems.start.copy(), 0.0
        self.closed = {}
        for i, (depth, rate, slip) in enumerate(systems.look(state)):
            if depth > SHALLOWEST:
                self.closed[i] = Closed(systems.contacts[i], depth, rate, slip)
        instants = np.linspace(self.span / points, self.span, points)
        found, steps, events = [], 0, 0
        while events < MOST_EVENTS:
            ta = self.enter(state, t)
            before = time.process_time()
            outcome, _, _, done, dense, _ = ta.propagate_until(self.span, c_output=points > 1)
            SPENT["compiled code"] += time.process_time() - before
            steps += done
            state, earlier, t = ta.state.copy(), t, ta.time
            if points > 1:
                inside_it = instants[(instants > earlier) & (instants <= t)]
                if len(inside_it):
                    found.extend(systems.measure(dense(inside_it).T.copy()).T)
            if outcome == hy.taylor_outcome.time_limit:
                return found, steps, events
            if outcome == hy.taylor_outcome.err_nf_state:
                raise RuntimeError("a state that is not finite")
            events += 1
            self.happen(self.events[-int(outcome) - 1], state, t)
        raise RuntimeError("too many events")


def main():
    job, method = jobs.load()
    systems = {}

    def march(tolerance, points):
        if tolerance not in systems:
            systems[tolerance] = Systems(job, tolerance)
        return March(systems[tolerance], job["span"]).run(points)

    clock = time.process_time if method == "whole" else lambda: SPENT["compiled code"]
    jobs.answer(job, march, "measured", clock, lambda: SPENT["compilation"])


if __name__ == "__main__":
    main()
