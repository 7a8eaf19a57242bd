"""The drive of a servo press as an FMU: a set speed over the stroke, PI control, a torque limit, no wind-up.

    ω*²(θ) = fast² + (slow² − fast²)·w(θ),      w: 0 on approach and return, 1 while forming, smooth between
    torque = limit(½·J·dω*²/dθ + P·e + I·∫e dt),  e = ω*(θ) − ω

It is a sampled controller. It measures at whole multiples of its sample time, and what it then
computes takes effect one sample later; so it takes θ where the crank will be by then. While the
limit holds the torque back, the integral stands still unless the error drives it back.

Masters differ in what they hand over at the very start: the first measurement is one sample later.
"""

from math import sqrt, tau

from variables import Unit

PARAMETERS = {
    "sample_time": (1e-3, "s", "Between two measurements, and from a measurement to its torque"),
    "fast_speed": (31.41592653589793, "rad/s", "Set speed of approach and return"),
    "slow_speed": (12.566370614359172, "rad/s", "Set speed of forming"),
    "slow_from": (5.846852994181004, "rad", "Crank angle at which the slow part begins"),
    "slow_to": (6.19591884457987, "rad", "Crank angle at which the slow part ends"),
    "braking": (1.1344640137963142, "rad", "Crank angle over which the press slows down"),
    "driving": (0.9599310885968813, "rad", "Crank angle over which it speeds up"),
    "inertia": (3.06, "kg.m2", "What the drive accelerates, reduced to the crank"),
    "proportional": (300.0, "N.m.s/rad", "Torque over speed error"),
    "integral": (9000.0, "N.m/rad", "Torque over summed speed error"),
    "limit": (2000.0, "N.m", "Largest torque"),
}
INPUTS = {
    "angle": (0.0, "rad", "Crank angle"),
    "speed": (0.0, "rad/s", "Crank speed"),
}
OUTPUTS = {
    "torque": (0.0, "N.m", "Torque on the crank"),
    "set_speed": (0.0, "rad/s", "Set speed at the last measurement"),
}
STATE = {
    "summed": (0.0, "N.m", "Integral part of the torque"),
    "next_torque": (0.0, "N.m", "Torque that takes effect at the next sample"),
    "sample": (1.0, "1", "Number of the next sample"),
}
# Of a sample time: what rounding makes of a whole multiple.
SLIVER = 1e-6


def smooth(share):
    """A step from 0 to 1 with its slope: 3s² − 2s³."""
    share = max(0.0, min(1.0, share))
    return share * share * (3.0 - 2.0 * share), 6.0 * share * (1.0 - share)


class ServoController(Unit):
    description = "Servo press drive: speed profile over the stroke, PI speed control, torque limit, anti-windup"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.declare("parameter", "fixed", PARAMETERS)
        # What it measures and what it holds changes at samples only: nothing to draw lines through.
        self.declare("input", "discrete", INPUTS)
        self.declare("output", "discrete", OUTPUTS)
        self.declare("local", "discrete", STATE)

    def profile(self, angle):
        """ω* and dω*²/dθ."""
        behind = (angle - (self["slow_from"] - self["braking"])) % tau
        slow_end = self["braking"] + (self["slow_to"] - self["slow_from"]) % tau
        if behind <= slow_end:
            weight, slope = smooth(behind / self["braking"])
            slope /= self["braking"]
        else:
            weight, slope = smooth((behind - slow_end) / self["driving"])
            weight, slope = 1.0 - weight, -slope / self["driving"]
        depth = self["slow_speed"] ** 2 - self["fast_speed"] ** 2
        return sqrt(self["fast_speed"] ** 2 + depth * weight), depth * slope

    def measure(self):
        """One sample."""
        there = self["angle"] + self["speed"] * self["sample_time"]
        set_speed, slope = self.profile(there)
        error = set_speed - self["speed"]
        summed = self["summed"] + self["integral"] * error * self["sample_time"]
        wanted = 0.5 * self["inertia"] * slope + self["proportional"] * error + summed
        torque = max(-self["limit"], min(self["limit"], wanted))
        if torque == wanted or (wanted - torque) * error < 0.0:
            self["summed"] = summed
        self["set_speed"], self["next_torque"] = set_speed, torque

    def do_step(self, time, step):
        end, sample_time = time + step, self["sample_time"]
        for _ in range(int(step / sample_time) + 2):
            due = self["sample"] * sample_time
            if due > end + SLIVER * sample_time:
                break
            self["torque"] = self["next_torque"]
            if due > end - SLIVER * sample_time:
                break
            self.measure()
            self["sample"] += 1.0
        return True
