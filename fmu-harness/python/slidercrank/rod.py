"""Decks for CalculiX of a uniform bar and of a connecting rod with two eyes, of hexahedra with 20 nodes.

    python -m slidercrank.rod -o rod.inp --shank-width 0.02 0.014

The rod lies along x from the big end's pin at 0 to the small end's at its length. The deck holds the half of it above the
plane of motion, z = 0, in SI units, with the sets of nodes that `slidercrank.modes.from_calculix` asks for. Eyes are rings; the
shank between them tapers from one width to the other and may be thinner than the eyes. Its corners at the eyes are sharp:
a rod with fillets is a matter for a mesher, see `fmu-harness/python/rod.geo`.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass, fields
from math import asin, cos, hypot, isclose, pi, sin
from pathlib import Path

Point = tuple[float, float]
Map = Callable[[float, float], Point]


@dataclass(frozen=True)
class Material:
    """Steel, unless told otherwise."""

    young: float = 207e9
    poisson: float = 0.3
    density: float = 7850.0


STEEL = Material()


@dataclass(frozen=True)
class Eye:
    """[m] A ring around a pin."""

    bore: float
    """Radius inside."""
    radius: float
    """Radius outside."""
    thickness: float


@dataclass(frozen=True)
class Rod:
    """[m] A connecting rod."""

    length: float = 0.12
    big: Eye = Eye(bore=0.016, radius=0.023, thickness=0.02)
    small: Eye = Eye(bore=0.01, radius=0.015, thickness=0.02)
    shank_width: tuple[float, float] = (0.02, 0.014)
    """At the big eye and at the small eye."""
    shank_thickness: float = 0.008


class Mesh:
    """Hexahedra with 20 nodes, which grow from quadrangles in the plane."""

    def __init__(self) -> None:
        self.nodes: dict[tuple[int, int, int], int] = {}
        self.positions: list[tuple[float, float, float]] = []
        self.elements: list[list[int]] = []

    def node(self, x: float, y: float, z: float) -> int:
        """The node at a place; nodes of neighbours are the same within a nanometre."""
        key = round(x * 1e9), round(y * 1e9), round(z * 1e9)
        if key not in self.nodes:
            self.positions.append((x, y, z))
            self.nodes[key] = len(self.positions)
        return self.nodes[key]

    def block(self, place: Map, along: int, across: int, levels: list[float]) -> None:
        """Elements on the image of the unit square (to the left from its first to its second side), between levels of z."""
        point = lambda i, j: place(i / (2 * along), j / (2 * across))
        for layer in zip(levels, levels[1:]):
            heights = layer[0], 0.5 * (layer[0] + layer[1]), layer[1]
            for i in range(0, 2 * along, 2):
                for j in range(0, 2 * across, 2):
                    corners = [(0, 0), (2, 0), (2, 2), (0, 2)]
                    middles = [(1, 0), (2, 1), (1, 2), (0, 1)]
                    order = [(*corner, 0) for corner in corners] + [(*corner, 2) for corner in corners]
                    order += [(*middle, 0) for middle in middles] + [(*middle, 2) for middle in middles]
                    order += [(*corner, 1) for corner in corners]
                    self.elements.append([self.node(*point(i + a, j + b), heights[c]) for a, b, c in order])

    def at(self, holds: Callable[[float, float, float], bool]) -> list[int]:
        return [number for number, place in enumerate(self.positions, 1) if holds(*place)]

    def deck(self, title: str, material: Material, sets: dict[str, list[int]]) -> str:
        """The text of a deck."""
        lines = ["*HEADING", title, "*NODE, NSET=ALL"]
        lines += [f"{number}, {x:.12g}, {y:.12g}, {z:.12g}" for number, (x, y, z) in enumerate(self.positions, 1)]
        lines.append("*ELEMENT, TYPE=C3D20, ELSET=ROD")
        for number, nodes in enumerate(self.elements, 1):
            lines += [f"{number}, " + ", ".join(map(str, nodes[:10])) + ",", ", ".join(map(str, nodes[10:]))]
        for name, members in sets.items():
            lines.append(f"*NSET, NSET={name}")
            lines += [", ".join(map(str, members[index : index + 12])) for index in range(0, len(members), 12)]
        lines += ["*MATERIAL, NAME=ROD", "*ELASTIC", f"{material.young:.12g}, {material.poisson:.12g}"]
        lines += ["*DENSITY", f"{material.density:.12g}", "*SOLID SECTION, ELSET=ROD, MATERIAL=ROD"]
        return "\n".join(lines) + "\n"


def bar(length: float, width: float, thickness: float, elements: tuple[int, int, int], material: Material = STEEL) -> str:
    """Deck of a uniform bar: so many elements along it, across it in the plane, and in half its thickness.

    Its ends stand for the bores.
    """
    mesh = Mesh()
    along, across, layers = elements
    levels = [0.5 * thickness * layer / layers for layer in range(layers + 1)]
    mesh.block(lambda s, t: (length * s, width * (t - 0.5)), along, across, levels)
    sets = {
        "BIG_END": mesh.at(lambda x, y, z: x == 0.0),
        "SMALL_END": mesh.at(lambda x, y, z: x == length),
        "SYMMETRY": mesh.at(lambda x, y, z: z == 0.0),
    }
    return mesh.deck("a uniform bar", material, sets)


def rod(shape: Rod = Rod(), fineness: int = 2, material: Material = STEEL) -> str:
    """Deck of a connecting rod; `fineness` elements make half the shank's thickness, and the others are in proportion."""
    mesh = Mesh()
    half = 0.5 * shape.shank_thickness
    inner = [half * layer / fineness for layer in range(fineness + 1)]
    across, around = 3 * fineness, 8 * fineness
    angles: list[float] = []
    for eye, centre, width, toward in (
        (shape.big, 0.0, shape.shank_width[0], 0.0),
        (shape.small, shape.length, shape.shank_width[1], pi),
    ):
        if not 0.0 < width < 2.0 * eye.radius or not eye.bore < eye.radius or eye.thickness < shape.shank_thickness:
            raise ValueError(f"{eye} cannot hold a shank of width {width} and thickness {shape.shank_thickness}")
        angle = asin(0.5 * width / eye.radius)
        angles.append(angle)
        outer = 0.5 * eye.thickness - half
        more = [half + outer * layer / fineness for layer in range(1, fineness + 1)] if outer > 1e-9 else []

        def ring(start: float, end: float, eye: Eye = eye, centre: float = centre) -> Map:
            """From the bore outwards, counter-clockwise."""
            radius = lambda s: eye.bore + s * (eye.radius - eye.bore)
            turn = lambda t: start + t * (end - start)
            return lambda s, t: (centre + radius(s) * cos(turn(t)), radius(s) * sin(turn(t)))

        mesh.block(ring(toward - angle, toward + angle), fineness, across, inner + more)
        mesh.block(ring(toward + angle, toward + 2.0 * pi - angle), fineness, around, inner + more)

    def shank(s: float, t: float) -> Point:
        """Straight lines from arc to arc."""
        from_, to = angles[0] * (2.0 * t - 1.0), pi - angles[1] * (2.0 * t - 1.0)
        first = shape.big.radius * cos(from_), shape.big.radius * sin(from_)
        second = shape.length + shape.small.radius * cos(to), shape.small.radius * sin(to)
        return first[0] + s * (second[0] - first[0]), first[1] + s * (second[1] - first[1])

    free = shape.length - shape.big.radius - shape.small.radius
    if free <= 0.0:
        raise ValueError(f"no room for a shank in {shape}")
    mesh.block(shank, max(4, round(4.0 * fineness * free / max(shape.shank_width))), across, inner)
    around_pin = lambda x, y, eye: isclose(hypot(x, y), eye.bore, rel_tol=1e-6)
    sets = {
        "BIG_END": mesh.at(lambda x, y, z: around_pin(x, y, shape.big)),
        "SMALL_END": mesh.at(lambda x, y, z: around_pin(x - shape.length, y, shape.small)),
        "SYMMETRY": mesh.at(lambda x, y, z: z == 0.0),
    }
    return mesh.deck("a connecting rod with two eyes", material, sets)


def main() -> None:
    """`python -m slidercrank.rod -o rod.inp`."""
    usual = Rod()
    parser = argparse.ArgumentParser(prog="slidercrank.rod", description="deck of a connecting rod; sizes in metres")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--length", type=float, default=usual.length)
    for end in ("big", "small"):
        for field in fields(Eye):
            parser.add_argument(f"--{end}-{field.name}", type=float, default=getattr(getattr(usual, end), field.name))
    parser.add_argument("--shank-width", type=float, nargs=2, default=usual.shank_width, metavar=("BIG", "SMALL"))
    parser.add_argument("--shank-thickness", type=float, default=usual.shank_thickness)
    parser.add_argument("--fineness", type=int, default=2)
    asked = parser.parse_args()
    big, small = (Eye(*(getattr(asked, f"{end}_{field.name}") for field in fields(Eye))) for end in ("big", "small"))
    shape = Rod(asked.length, big, small, (asked.shank_width[0], asked.shank_width[1]), asked.shank_thickness)
    Path(asked.output).write_text(rod(shape, asked.fineness), encoding="utf-8")


if __name__ == "__main__":
    main()
