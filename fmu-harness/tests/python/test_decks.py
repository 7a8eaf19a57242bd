"""Decks are read, and what cannot be a rod is refused, without CalculiX."""

import numpy
import pytest

from slidercrank.deck import Deck, ModesError, face_area
from slidercrank.modes import from_calculix
from slidercrank.rod import Rod, bar, rod

LENGTH = 0.12


def test_a_missing_program_is_named(deck):
    with pytest.raises(ModesError, match="no-such-program is not installed; Debian's package is calculix-ccx"):
        from_calculix(deck(bar(LENGTH, 0.01, 0.01, (1, 1, 1))), program="no-such-program")


def test_decks_are_read_with_what_they_include(deck):
    deck("*NODE, NSET=ALL\n1, 0, 0\n2, 1., 0, 0\n** a remark\n3,0,1,0\n", "nodes.inp")
    file = deck(
        "*INCLUDE, INPUT=nodes.inp\n*NSET, NSET=Some, GENERATE\n1, 3, 2\n*Nset,nset=more\nSOME, 2,\n"
        "*ELEMENT, TYPE=CPS3\n1, 1, 2, 3\n*STEP\n*NODE\n9, 9, 9, 9\n*END STEP\n"
    )
    read = Deck(file)
    assert read.nodes == {1: (0.0, 0.0, 0.0), 2: (1.0, 0.0, 0.0), 3: (0.0, 1.0, 0.0)}
    assert read.sets == {"ALL": {1, 2, 3}, "SOME": {1, 3}, "MORE": {1, 2, 3}}
    assert read.elements == [] and not any("CPS3" in line or "STEP" in line for line in read.text)
    with pytest.raises(ModesError, match="`1, x` cannot be read"):
        Deck(deck("*NODE\n1, x\n"))


def test_a_bore_has_its_area_and_its_centre():
    square = numpy.array([(0, 0, 0), (2, 0, 0), (2, 3, 0), (0, 3, 0)], float)
    assert face_area(square) == pytest.approx([1.5] * 4)
    assert face_area(square[:3]) == pytest.approx([1.0] * 3)
    middles = lambda corners: numpy.vstack([corners, 0.5 * (corners + numpy.roll(corners, -1, axis=0))])
    assert face_area(middles(square)) == pytest.approx([-0.5] * 4 + [2.0] * 4)
    assert face_area(middles(square[:3])) == pytest.approx([0.0] * 3 + [1.0] * 3, abs=1e-12)


def test_an_eye_must_hold_its_shank():
    with pytest.raises(ValueError, match="cannot hold a shank"):
        rod(Rod(shank_width=(0.05, 0.01)))
    with pytest.raises(ValueError, match="no room for a shank"):
        rod(Rod(length=0.03))
