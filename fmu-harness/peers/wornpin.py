"""SciPy's integrators on the worn slider pin, with equations of its own, compiled by numba.

Crank at constant speed; rod hung on its pin, turning by theta about it; slider on an ideal guide at x. The journal of
the slider sits in the bearing of the rod with clearance. Newton for the slider, Euler about the crank pin for the rod.
The right-hand side is first compared with the scene's own at many states, with the contact open and closed.
"""

import ctypes
import math

import numpy as np
from numba import njit
from scipy.integrate import solve_ivp

import job as jobs

LANKARANI_NIKRAVESH, AMBROSIO, CLEARANCE = 5, 2, 2
AGREEMENT = 1e-12  # of the two right-hand sides, relative to the largest rate of a state's kind
STATES = 2000
DEEPEST = 2e-4  # [m] Rounding in a penetration of micrometres is already 1e-11 of it
LONGEST_STEP = 1e-5  # [s] solve_ivp sees an event only between the ends of a step: longer ones skip whole hops
SMALLEST_RTOL = 2.3e-14  # what solve_ivp allows; the weights are absolute


@njit(cache=True)
def rates(t, y, p, closed, approach):
    start, speed, r, l, m2, j2, s2, m3, h, bearing, c, k, chi, limit, mu, v0, v1, g = p
    x, theta, vx, omega = y
    crank = start + speed * t
    cc, sc, cr, sr = math.cos(crank), math.sin(crank), math.cos(theta), math.sin(theta)
    # Small end of the rod, and the journal's place in it.
    ex = x - (r * cc + l * cr)
    ey = h - (r * sc + l * sr)
    fx = fy = couple = 0.0
    eps = math.sqrt(ex * ex + ey * ey)
    if closed and eps > c:
        dx = vx + r * speed * sc + l * omega * sr
        dy = -r * speed * cc - l * omega * cr
        nx, ny = ex / eps, ey / eps
        rate = dx * nx + dy * ny
        ratio = rate / approach
        if limit > 0.0:
            ratio = min(ratio, limit)
        normal = max(0.0, k * (eps - c) ** 1.5 * (1.0 + chi * ratio))
        # Material speed at the contact point; the slider does not turn.
        slip = -dx * ny + dy * nx - bearing * omega
        friction = mu * normal * min(max((abs(slip) - v0) / (v1 - v0), 0.0), 1.0) * math.copysign(1.0, slip)
        fx = -normal * nx + friction * ny
        fy = -normal * ny - friction * nx
        # The opposite force on the rod, at the contact point seen from the small end.
        couple = -(bearing * nx * fy - bearing * ny * fx)
    # Crank pin's acceleration points to the crank's centre.
    ax, ay = -r * speed * speed * cc, -r * speed * speed * sc
    moment = couple - (l * cr * fy - l * sr * fx) - m2 * s2 * (cr * (ay + g) - sr * ax)
    return np.array([vx, omega, fx / m3, moment / (j2 + m2 * s2 * s2)])


@njit(cache=True)
def penetration(t, y, p):
    crank = p[0] + p[1] * t
    ex = y[0] - p[2] * math.cos(crank) - p[3] * math.cos(y[1])
    ey = p[8] - p[2] * math.sin(crank) - p[3] * math.sin(y[1])
    return math.sqrt(ex * ex + ey * ey) - p[10]


@njit(cache=True)
def penetration_rate(t, y, p):
    crank = p[0] + p[1] * t
    cc, sc, cr, sr = math.cos(crank), math.sin(crank), math.cos(y[1]), math.sin(y[1])
    ex, ey = y[0] - p[2] * cc - p[3] * cr, p[8] - p[2] * sc - p[3] * sr
    dx = y[2] + p[2] * p[1] * sc + p[3] * y[3] * sr
    dy = -p[2] * p[1] * cc - p[3] * y[3] * cr
    return (dx * ex + dy * ey) / math.sqrt(ex * ex + ey * ey)


def constants(parameters):
    """The numbers of the equations; says so if the scene is another problem."""
    a = parameters.__getitem__
    contact = "joint.C."
    expected = {
        "drive.mode": 2, "joint.A.model": 1, "joint.B.model": 1, "joint.T.model": 1, "joint.C.model": CLEARANCE,
        "joint.C.law": LANKARANI_NIKRAVESH, "joint.C.friction.law": AMBROSIO, "joint.C.exponent": 1.5,
        "rod.com.y": 0.0, "rod.flexible.bending_modes": 0, "rod.flexible.axial_modes": 0, "slider.centre.y": 0.0,
        "gravity.angle": -math.pi / 2, "slider.load.offset": 0.0,
    }  # fmt: skip
    other = {name: a(name) for name, value in expected.items() if a(name) != value}
    if other:
        raise SystemExit(f"these equations are of another scene: {other}")
    bearing, c, restitution = a(contact + "radius"), a(contact + "clearance"), a(contact + "restitution")
    compliance = sum(
        (1 - a(f"joint.C.poisson.{part}") ** 2) / a(f"joint.C.young.{part}") for part in ("bearing", "journal")
    )
    k = a(contact + "stiffness") or 4 / (3 * compliance) * math.sqrt(bearing * (bearing - c) / c)
    chi = 0.75 * (1 - restitution**2)  # Lankarani, Nikravesh, J. Mech. Des. 112 (1990) 369
    return np.array([
        a("crank.angle_start"), a("crank.speed_start"), a("crank.length"), a("rod.length"), a("rod.mass"),
        a("rod.inertia"), a("rod.com.x"), a("slider.mass"), a("guide.offset"), bearing, c, k, chi,
        a(contact + "ratio_limit"), a(contact + "friction.coefficient"), a(contact + "friction.v0"),
        a(contact + "friction.v1"), a("gravity"),
    ])  # fmt: skip


def compare(job, p):
    """Stops if the scene's own right-hand side is another one."""
    library = ctypes.CDLL(job["library"])
    library.equations_open.restype = ctypes.c_void_p
    system = ctypes.c_void_p(library.equations_open(job["file"].encode()))
    number, array = ctypes.c_double, ctypes.POINTER(ctypes.c_double)
    pointer = lambda values: values.ctypes.data_as(array)
    chance = np.random.default_rng(1)
    largest = np.zeros(4)
    difference = np.zeros(4)
    for state in range(STATES):
        closed = state % 2 == 1
        # On the clearance circle, where the contact closes; then somewhat deeper or less deep, at other rates.
        t, direction = chance.uniform(0, 0.02), chance.uniform(0, 2 * math.pi)
        crank = p[0] + p[1] * t
        theta = math.asin((p[8] - p[2] * math.sin(crank) - p[10] * math.sin(direction)) / p[3])
        x = p[2] * math.cos(crank) + p[3] * math.cos(theta) + p[10] * math.cos(direction)
        y = np.array([x, theta, chance.uniform(-30, 30), chance.uniform(-300, 300)])
        ours, theirs = np.empty(4), np.empty(4)
        library.equations_start(system, pointer(theirs))
        approach = math.inf
        if closed:
            y[2:] *= math.copysign(1.0, penetration_rate(t, y, p))
            approach = max(penetration_rate(t, y, p), job["parameters"]["joint.C.speed_floor"])
            library.equations_cross(system, number(t), pointer(y), (ctypes.c_int32 * 1)(1))
        y[0] += chance.uniform(-DEEPEST, DEEPEST)
        y[2:] *= chance.uniform(-1, 1)
        library.equations_rates(system, number(t), pointer(y), pointer(theirs))
        ours = rates(t, y, p, closed, approach)
        largest = np.maximum(largest, np.abs(theirs))
        difference = np.maximum(difference, np.abs(ours - theirs))
    library.equations_close(system)
    if np.any(difference > AGREEMENT * largest):
        raise SystemExit(f"the two right-hand sides differ by {difference / largest} of the largest rates")


def march(job, p, method, tolerance, points):
    span = job["span"]
    y, t = np.array(job["start"]), 0.0
    closed, approach = False, math.inf
    weights = tolerance * np.array(job["scales"])
    instants = np.linspace(span / points, span, points)
    found, evaluations, events = [], 0, 0

    def touches(t, y):
        depth = penetration(t, y, p)
        return depth if closed else -depth

    touches.terminal, touches.direction = True, -1
    while t < span:
        fun = lambda t, y: rates(t, y, p, closed, approach)
        ahead = instants[instants > t]
        done = solve_ivp(fun, (t, span), y, method, ahead, events=touches, rtol=SMALLEST_RTOL, atol=weights,
                         max_step=LONGEST_STEP)  # fmt: skip
        if done.status < 0:
            raise RuntimeError(done.message)
        evaluations += done.nfev
        found.extend(done.y[:2].T if len(done.t) else [])
        if done.status == 0:
            break
        events += 1
        t, y = done.t_events[0][0], done.y_events[0][0]
        closed = not closed
        approach = max(penetration_rate(t, y, p), job["parameters"]["joint.C.speed_floor"]) if closed else math.inf
    return found, evaluations, events


def main():
    job, method = jobs.load()
    p = constants(job["parameters"])
    compare(job, p)
    jobs.answer(job, lambda tolerance, points: march(job, p, method, tolerance, points))


if __name__ == "__main__":
    main()
