"""Variables of a PythonFMU slave as tables: name, start value, unit, what it is.

PythonFMU knows no units; whoever packages the slave finds them in `units`.
"""

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class Unit(Fmi2Slave):
    """A slave whose variables are its attributes; the local ones make its state complete."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.units = {}
        self._values = {}

    def declare(self, causality, variability, rows):
        for name, (start, unit, what) in rows.items():
            self._values[name] = start
            self.units[name] = unit
            variable = Real(
                name,
                causality=Fmi2Causality[causality],
                variability=Fmi2Variability[variability],
                description=what,
                getter=lambda name=name: self._values[name],
                setter=lambda value, name=name: self._values.__setitem__(name, value),
            )
            self.register_variable(variable, nested=False)

    def __getitem__(self, name):
        return self._values[name]

    def __setitem__(self, name, value):
        self._values[name] = value
