"""What `slidercrank.modes` reads of a deck for CalculiX or Abaqus: nodes, sets of nodes, faces of solid elements."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy
from numpy.typing import NDArray

Vector = NDArray[numpy.float64]


class ModesError(RuntimeError):
    """The deck cannot be read, CalculiX refuses it, or it is no rod that a table can describe; the text says why."""


@dataclass(frozen=True)
class Form:
    """A form of solid element, with nodes counted from 0."""

    faces: tuple[tuple[int, ...], ...]
    """The corners of each face, in order around it."""
    edges: tuple[tuple[int, int], ...]
    """The corners of each edge, in the order of the nodes in their middle."""


TETRAHEDRON = Form(((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)), ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)))
WEDGE = Form(
    ((0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
)
HEXAHEDRON = Form(
    ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
    ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)),
)
FORMS = {4: (TETRAHEDRON, 4), 10: (TETRAHEDRON, 4), 6: (WEDGE, 6), 15: (WEDGE, 6), 8: (HEXAHEDRON, 8), 20: (HEXAHEDRON, 8)}
"""By number of nodes, with the number of corners."""


class Deck:
    """A deck with the files that it includes, without comments, steps and elements that are not solid."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self.text = list(solid_elements(lines(file)))
        self.nodes: dict[int, tuple[float, float, float]] = {}
        self.sets: dict[str, set[int]] = {}
        self.elements: list[list[int]] = []
        self.unfinished: list[int] = []
        keyword, options = "", {}
        for line in self.text:
            words = [word.strip() for word in line.split(",")]
            if line.startswith("*"):
                keyword = words[0].upper()
                options = {key.strip().upper(): value.strip().upper() for key, _, value in (word.partition("=") for word in words[1:])}
                continue
            try:
                self.read(keyword, options, [word for word in words if word], unfinished=line.rstrip().endswith(","))
            except (ValueError, KeyError) as error:
                raise ModesError(f"{file}: {keyword}: `{line.strip()}` cannot be read") from error

    def read(self, keyword: str, options: dict[str, str], words: list[str], unfinished: bool) -> None:
        """One line of data."""
        if keyword == "*NODE":
            x, y, z = ([float(word) for word in words[1:]] + [0.0, 0.0, 0.0])[:3]
            self.nodes[int(words[0])] = (x, y, z)
            if "NSET" in options:
                self.sets.setdefault(options["NSET"], set()).add(int(words[0]))
        elif keyword == "*NSET":
            into = self.sets.setdefault(options["NSET"], set())
            if "GENERATE" in options:
                first, last, step = ([int(word) for word in words] + [1])[:3]
                into.update(range(first, last + 1, step))
            else:
                for word in words:
                    into.update({int(word)} if word.isdigit() else self.sets[word.upper()])
        elif keyword == "*ELEMENT" and options.get("TYPE", "").startswith("C3D"):
            self.unfinished += [int(word) for word in words]
            # An element of many nodes goes on in the next line.
            wanted = int("".join(filter(str.isdigit, options["TYPE"][3:])))
            if len(self.unfinished) > wanted or not unfinished:
                self.elements.append(self.unfinished[1:])
                self.unfinished = []

    def members(self, name: str) -> set[int]:
        """The nodes of a set."""
        if name.upper() not in self.sets:
            raise ModesError(f"{self.file}: there is no set of nodes {name.upper()}; there are: {', '.join(sorted(self.sets))}")
        return self.sets[name.upper()]

    def surface(self, members: set[int]) -> dict[int, float]:
        """The surface that faces of elements cover whose nodes are all among these: ∫N dA of each node's shape function."""
        area: dict[int, float] = {}
        for element in self.elements:
            if len(element) not in FORMS or len(members.intersection(element)) < 3:
                continue
            form, corners = FORMS[len(element)]
            middles = {frozenset(edge): corners + index for index, edge in enumerate(form.edges)}
            for face in form.faces:
                around = zip(face, (*face[1:], face[0]))
                between = [middles[frozenset(edge)] for edge in around] if len(element) > corners else []
                nodes = [element[index] for index in (*face, *between)]
                if members.issuperset(nodes):
                    parts = face_area(numpy.array([self.nodes[node] for node in nodes]))
                    for node, part in zip(nodes, parts):
                        area[node] = area.get(node, 0.0) + float(part)
        return area


def face_area(positions: Vector) -> Vector:
    """∫N dA for the nodes of a face: 3 or 4 corners, then as many nodes between them or none."""
    triangle = len(positions) % 3 == 0
    corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)] if triangle else [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
    places = numpy.array(corners)
    if len(positions) > len(corners):
        places = numpy.vstack([places, 0.5 * (places + numpy.roll(places, -1, axis=0))])
    # The face's shape functions are polynomials that are 1 at their node and 0 at the others.
    powers = [(0, 0), (1, 0), (0, 1), (1, 1), (2, 0), (0, 2), (2, 1), (1, 2)]
    powers = powers[:3] if len(positions) == 3 else powers[: len(positions)]
    i, j = numpy.array(powers).T
    value = lambda s, t: s**i * t**j
    shapes = numpy.linalg.inv([value(s, t) for s, t in places])
    points, weights = numpy.polynomial.legendre.leggauss(4)
    parts = numpy.zeros(len(positions))
    for (a, wa), (b, wb) in product(zip(points, weights), repeat=2):
        # Of a triangle, the square is folded together at one side.
        s, t = (0.5 * (1 + a), 0.25 * (1 + b) * (1 - a)) if triangle else (a, b)
        weight = wa * wb * (0.125 * (1 - a) if triangle else 1.0)
        slope_s = (i * s ** numpy.maximum(i - 1, 0) * t**j) @ shapes @ positions
        slope_t = (j * s**i * t ** numpy.maximum(j - 1, 0)) @ shapes @ positions
        parts += weight * numpy.linalg.norm(numpy.cross(slope_s, slope_t)) * (value(s, t) @ shapes)
    return parts


def solid_elements(text: Iterator[str]) -> Iterator[str]:
    """The lines without elements of other kinds: meshers write the triangles of named surfaces beside the solid."""
    left_out = False
    for line in text:
        if line.startswith("*"):
            words = line.upper().replace(" ", "").split(",")
            left_out = words[0] == "*ELEMENT" and not any(word.startswith("TYPE=C3D") for word in words)
        if not left_out:
            yield line


def lines(file: Path, depth: int = 0) -> Iterator[str]:
    """A deck's lines without comments and steps, with those of the files that it includes."""
    if depth > 8:
        raise ModesError(f"{file}: decks include each other")
    try:
        text = file.read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        raise ModesError(f"{file}: {error.strerror}") from error
    within_step = False
    for line in text.splitlines():
        keyword = line.upper().replace(" ", "")
        if keyword.startswith("*STEP"):
            within_step = True
        if keyword.startswith("*INCLUDE") and not within_step:
            _, _, name = line.partition("=")
            yield from lines(file.parent / name.strip().strip('"'), depth + 1)
        elif not within_step and not line.startswith("**") and line.strip():
            yield line
        if keyword.startswith("*ENDSTEP"):
            within_step = False
