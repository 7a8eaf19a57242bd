"""A drive's speed controller as an FMU: PI on the crank's speed, limited torque, no wind-up.

    torque = limit(holding + P·e + I·∫e dt),   e = set_speed − speed

While the limit holds the torque back, the integral stands still (conditional integration).

At its first communication point a coupled input is not yet there: some masters hand over 0, others
the plant's first output. So the controller begins as if at its set speed.
"""

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class SpeedController(Fmi2Slave):
    description = "PI speed controller with torque limit and anti-windup"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.speed = 0.0
        self.torque = 0.0
        self.set_speed = 31.41592653589793
        self.holding = 80.0
        self.proportional = 600.0
        self.integral = 3000.0
        self.limit = 150.0
        self._summed = 0.0
        for name in ("set_speed", "holding", "proportional", "integral", "limit"):
            self.register_variable(
                Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.tunable)
            )
        self.register_variable(Real("speed", causality=Fmi2Causality.input))
        self.register_variable(Real("torque", causality=Fmi2Causality.output))

    def do_step(self, time, step):
        error = self.set_speed - self.speed if time > 0.0 else 0.0
        summed = self._summed + self.integral * error * step
        wanted = self.holding + self.proportional * error + summed
        self.torque = max(-self.limit, min(self.limit, wanted))
        if self.torque == wanted:
            self._summed = summed
        return True
