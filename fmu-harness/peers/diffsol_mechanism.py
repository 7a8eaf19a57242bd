"""The rigid mechanism in diffsol: methods written in Rust, equations compiled by LLVM, contacts located as roots.

The equations are those of `heyoka_mechanism`, each operation a tensor of the language DiffSL. There is one compiled system
for each set of closed contacts that occurs, compiled when it first does and kept. The laws are written as a whole, with
`max` and `min`: a method that controls its error steps over their kinks. A touch or a parting stops the solver, since what a
contact remembers of its approach changes there; only then Python is called.

    python diffsol_mechanism.py JOB tsit45|bdf[-whole]

States are in units of their scales, and the tolerance is absolute. CPU time is that inside diffsol's `solve`, or all of it
(`-whole`). Neither has compilation. Steps are counted, since diffsol does not tell its evaluations.
"""

import re
import time

import heyoka as hy
import numpy as np
import pydiffsol as ds

import job as jobs
from heyoka_mechanism import SPENT, Compiled

MARGIN = 1e-14  # [m] From where a contact opens to where it closes: a root at the start of a piece is of no sign.
SMALLEST_RTOL = 1e-14  # The weights are absolute.
FIRST_STEP, SHORTEST_STEP = 1e-7, 1e-16  # [s]
MOST_EVENTS = 100_000
# What heyoka's lists of operations call otherwise.
WORDS = {"combined_sin": "sin", "combined_cos": "cos"}


def operations(prefix, outputs, variables):
    """Lines of DiffSL for expressions of `variables`, pairs of a name and an expression, and the names of their results."""
    listed = hy.cfunc([hy.expression(0.0) + x for x in outputs], [x for _, x in variables]).dc
    names = [name for name, _ in variables]
    inputs, count = len(variables), len(outputs)
    lines = []
    for i, operation in enumerate(map(str, listed[inputs : len(listed) - count])):
        names.append(f"{prefix}{i}")
        lines.append(f"{names[-1]} {{ {translated(operation, names)} }}")
    return lines, [translated(str(x), names) for x in listed[len(listed) - count :]]


def translated(operation, names):
    """One of heyoka's elementary operations in DiffSL."""
    text = re.sub(r"\bu_(\d+)\b", lambda found: names[int(found[1])], operation)
    text = re.sub(r"^sub\((.*), (.*)\)$", r"(\1 - \2)", text)
    text = re.sub(r"^div\((.*), (.*)\)$", r"(\1 / \2)", text)
    text = re.sub(r"^(\S+)\*\*0\.50*$", r"sqrt(\1)", text)
    text = re.sub(r"^(\S+)\*\*(\S+)$", r"pow(\1, \2)", text)
    for theirs, ours in WORDS.items():
        text = text.replace(theirs, ours)
    return text


class Systems(Compiled):
    """Solvers by one method."""

    def __init__(self, job, method):
        super().__init__(job, ["depth", "rate", "touch"])
        self.method, self.scales = method, self.scaled(job)

    def scaled(self, job):
        """Scale of each state: lengths as in the scene's own norm, angles as far as they move the rod's or crank's end."""
        m, half = self.m, len(job["scales"]) // 2
        length, per_second = min(job["scales"][:half]), job["scales"][half] / job["scales"][0]
        arm = {"crank": m.a["crank.length"], "rod": m.a["rod.length"], "slider": m.a["slider.length"] or 1.0}
        coordinates = np.full(len(m.q), length)
        for body, i in m.index.items():
            if i < len(m.q):
                coordinates[i] = length / arm[body]
        return np.concatenate([coordinates, per_second * coordinates, [length / arm["crank"]] * len(m.extra)]).tolist()

    def make(self, closed):
        """Parameters are the start in units of the scales, then for each contact what it remembers, and what shifts its depth."""
        m, n = self.m, len(self.variables)
        states = [(f"y{i}", x) for i, x in enumerate(self.variables)]
        lines = [f"y{i} {{ {scale!r} * z{i} }}" for i, scale in enumerate(self.scales)]
        pushes, stops = [], []
        for k, contact in enumerate(self.contacts):
            if k not in closed:
                own, [touch] = operations(f"touch{k}x", [contact.touch], states)
                lines += own
                stops.append(f"{touch} - shift{k}")
                continue
            own, [depth, rate, slip] = operations(f"contact{k}x", [contact.depth, contact.rate, contact.slip], states)
            top = 1 + contact.chi * contact.limit if contact.limit > 0 else None
            damped = f"1.0 + {contact.chi!r} * {rate} * per{k}"
            damped = f"min({damped}, {top!r})" if top is not None else damped
            ramp = f"min(max((abs({slip}) - {contact.v0!r}) * {1 / (contact.v1 - contact.v0)!r}, 0.0), 1.0)"
            lines += [
                *own,
                f"deep{k} {{ {depth} + shift{k} }}",
                f"push{k} {{ {contact.stiffness!r} * pow(max(deep{k}, 0.0), {contact.exponent!r}) * max({damped}, 0.0) }}",
                f"rub{k} {{ {contact.friction!r} * push{k} * copysign({ramp}, {slip}) }}",
            ]
            stops.append(f"deep{k}")
            pushes.append((contact, k, *hy.make_vars(f"push{k}", f"rub{k}")))

        def loads(forces):
            for contact, _, push, rub in pushes:
                contact.load(m, forces, push, rub)

        known = [*states, *((f"push{k}", push) for _, k, push, _ in pushes), *((f"rub{k}", rub) for _, k, _, rub in pushes)]
        rates = [*m.u, *m.accelerations(loads), *(rate for _, rate, _ in m.extra)]
        own, rates = operations("motion", rates, known)
        inputs = [*(f"s{i}" for i in range(n)), *(f"{x}{k}" for k in range(len(self.contacts)) for x in ("per", "shift"))]
        code = [
            f"in_i {{ {', '.join(f'{name} = 1.0' for name in inputs)} }}",
            f"u_i {{ {', '.join(f'z{i} = s{i}' for i in range(n))} }}",
            *lines,
            *own,
            f"F_i {{ {', '.join(f'({rate}) * {1 / scale!r}' for rate, scale in zip(rates, self.scales))} }}",
        ]
        if stops:
            code.append(f"stop_i {{ {', '.join(stops)} }}")
        ode = ds.Ode("\n".join(code) + "\n", matrix_type=ds.faer_dense)
        ode.ode_solver = getattr(ds, self.method)
        ode.rtol, ode.h0 = SMALLEST_RTOL, FIRST_STEP
        ode.options.min_timestep = SHORTEST_STEP
        return ode


class March:
    """One run."""

    def __init__(self, systems, tolerance, span):
        self.systems, self.tolerance, self.span = systems, tolerance, span

    def parameters(self, state):
        now, numbers = self.systems.look(state), []
        for k, (depth, _, touch) in enumerate(now):
            if k in self.closed:
                numbers += [1 / self.closed[k], max(0.0, MARGIN - depth)]
            else:
                numbers += [0.0, max(0.0, touch + MARGIN)]
        return np.concatenate([state / self.systems.scales, numbers])

    def happen(self, before, state):
        """Closes or opens the contact whose root the solver has stopped at, and all others that are past theirs."""
        was, now = self.systems.look(before), self.systems.look(state)
        nearest, least = None, np.inf
        for k in range(len(now)):
            column = 0 if k in self.closed else 2
            share = abs(now[k, column]) / (abs(was[k, column]) + abs(now[k, column]) + 1e-300)
            if share < least:
                nearest, least = k, share
        for k, contact in enumerate(self.systems.contacts):
            depth, rate, touch = now[k]
            if k in self.closed:
                if k == nearest or (depth < 0 and rate < 0):
                    del self.closed[k]
            elif k == nearest or (touch > 0 and rate > 0):
                self.closed[k] = max(contact.floor, rate)

    def run(self, points):
        systems = self.systems
        state, t = systems.start.copy(), 0.0
        start = enumerate(zip(systems.contacts, systems.look(state)))
        self.closed = {k: max(contact.floor, rate) for k, (contact, (depth, rate, _)) in start if depth > 0}
        instants = np.linspace(self.span / points, self.span, points)
        found, steps, events = [], 0, 0
        while events < MOST_EVENTS:
            ode = systems.system(frozenset(self.closed))
            parameters = self.parameters(state)
            ode.atol, ode.t0 = self.tolerance, t
            before = time.process_time()
            if points > 1:
                solution = ode.solve_dense(parameters, instants[instants > t])
            else:
                solution = ode.solve(parameters, self.span)
            SPENT["compiled code"] += time.process_time() - before
            ts, ys = solution.ts, np.ascontiguousarray(solution.ys.T * systems.scales)
            steps += len(ts)
            stopped = ts[-1] < self.span
            if points > 1:
                reached = ys[:-1] if stopped else ys
                if len(reached):
                    found.extend(systems.measure(reached.T.copy()).T)
            if not stopped:
                return found, steps, events
            events += 1
            last, state, t = (ys[-2] if len(ys) > 1 else state), ys[-1].copy(), ts[-1]
            self.happen(last, state)
        raise RuntimeError("too many events")


def main():
    job, word = jobs.load()
    method, _, whole = word.partition("-")
    systems = Systems(job, method)

    def march(tolerance, points):
        run = lambda points: March(systems, tolerance, job["span"]).run(points)
        found, _, events = run(points)
        return found, run(1)[1] if points > 1 else 0, events

    clock = time.process_time if whole else lambda: SPENT["compiled code"]
    jobs.answer(job, march, "measured", clock, lambda: SPENT["compilation"])


if __name__ == "__main__":
    main()
