"""The sheet that a blanking press cuts, as an FMU: a force on the slider over the crank's angle.

The force rises when the punch meets the sheet, falls within half a degree when the sheet breaks and
pulls back for a moment (snap-through), and is a straight line between the points of its profile. The
points are parameters: a package takes them from its scene.
"""

from math import tau

from variables import Unit

POINTS = 16
PARAMETERS = {
    f"{what}[{number}]": (0.0, unit, f"Point {number} of the profile: {meaning}")
    for number in range(1, POINTS + 1)
    for what, unit, meaning in (("at", "rad", "crank angle"), ("load", "N", "force along the guide"))
}
INPUTS = {
    "angle": (0.0, "rad", "Crank angle"),
    "velocity": (0.0, "m/s", "Velocity of the slider"),
}
OUTPUTS = {
    "force": (0.0, "N", "Force on the slider along the guide, negative towards the crank"),
    "work": (0.0, "J", "Work that the slider has done on it, as it is handed force and velocity"),
}


class Sheet(Unit):
    description = "Blanking force with snap-through over the crank's angle"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.declare("parameter", "fixed", PARAMETERS)
        self.declare("input", "continuous", INPUTS)
        self.declare("output", "continuous", OUTPUTS)

    def exit_initialization_mode(self):
        """Points that were left at their start values stand at angle 0 and do not count."""
        points = [(self[f"at[{number}]"], self[f"load[{number}]"]) for number in range(1, POINTS + 1)]
        points = points[:1] + [point for point in points[1:] if point[0] > 0.0]
        (first, low), (last, high) = points[0], points[-1]
        points = [(last - tau, high), *points, (first + tau, low)]
        self._lines = list(zip(points, points[1:]))
        self["force"] = self.at(self["angle"])

    def at(self, angle):
        angle %= tau
        for (here, low), (there, high) in self._lines:
            if angle <= there:
                return low + (high - low) * (angle - here) / (there - here)

    def do_step(self, time, step):
        before, self["force"] = self["force"], self.at(self["angle"])
        self["work"] -= 0.5 * (before + self["force"]) * self["velocity"] * step
        return True
