"""The sheet that a blanking press cuts, as an FMU: a force on the slider over the crank's angle.

Bottom dead centre is at angle 0. The punch meets the sheet before it, the force rises, and falls
when the sheet breaks; on the way up the sheet holds the punch back. Between the points the force is
a straight line, since a jump would have another effect in every communication step.
"""

from math import tau

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

# (degrees of crank angle, newtons along the guide, negative towards the crank)
PROFILE = [
    (0.0, 0.0),
    (12.0, 8e3),
    (20.0, 0.0),
    (340.0, 0.0),
    (341.5, -160e3),
    (344.0, -280e3),
    (347.0, -300e3),
    (350.0, -260e3),
    (350.5, 45e3),
    (352.0, -10e3),
    (356.0, 0.0),
    (360.0, 0.0),
]


def force(angle):
    degrees = angle % tau * 360.0 / tau
    for (here, low), (there, high) in zip(PROFILE, PROFILE[1:]):
        if degrees <= there:
            return low + (high - low) * (degrees - here) / (there - here)
    return 0.0


class Sheet(Fmi2Slave):
    description = "Blanking force over crank angle"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.angle = 0.0
        self.force = 0.0
        self.register_variable(Real("angle", causality=Fmi2Causality.input))
        self.register_variable(Real("force", causality=Fmi2Causality.output))

    def do_step(self, time, step):
        self.force = force(self.angle)
        return True
