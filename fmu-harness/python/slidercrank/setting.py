"""What a variable may be set to, as the command line has it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import SupportsFloat

from fmpy.model_description import ModelVariable

Value = float | int | bool | str
"""A number, true or false; an item of an enumeration by its name; or a text that reads as one of them."""

FLAGS = {"true": 1.0, "false": 0.0}
INTEGERS = 2.0**31
"""What an integer of 32 bits stays below."""


def value_of(variable: ModelVariable, given: Value) -> float | int | bool:
    """In the variable's own type; a `ValueError` if it is not of that type. Its range is for the FMU to check."""
    number = _number(given)
    match variable.type:
        case "Real" | "Float64":
            if math.isfinite(number):
                return number
            wanted = "a finite number"
        case "Boolean":
            number = FLAGS.get(str(given).lower(), number)
            if number in (0.0, 1.0):
                return bool(number)
            wanted = "true or false"
        case "Integer" | "Int32" | "Enumeration":
            names = items(variable)
            if isinstance(given, str) and given in names:
                return names[given]
            if number.is_integer() and -INTEGERS <= number < INTEGERS:
                return int(number)
            wanted = f"one of {', '.join(names)}" if names else "a whole number"
            if not names and number.is_integer():
                wanted += " of 32 bits"
        case _:
            wanted = "of a type that can be set"
    raise ValueError(f"`{variable.name}`: `{given}` is not {wanted}")


def items(variable: ModelVariable) -> Mapping[str, int]:
    """The items of an enumeration, by their names."""
    declared = variable.declaredType
    return {item.name: int(item.value) for item in declared.items} if declared is not None else {}


def limits(variable: ModelVariable) -> tuple[float, float]:
    """The least and the greatest legal value."""
    if variable.type == "Boolean":
        return 0.0, 1.0
    if numbers := items(variable).values():
        return float(min(numbers)), float(max(numbers))
    return float(variable.min or -math.inf), float(variable.max or math.inf)


def _number(given: SupportsFloat | str) -> float:
    """Not a number if it does not read as one."""
    try:
        return float(given)
    except (TypeError, ValueError, OverflowError):
        return math.nan
