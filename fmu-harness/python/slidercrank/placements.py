"""A study of where clearances are, such as `ma-qian.toml`, by joints: which of them have how much."""

from __future__ import annotations

import pandas

JOINTS = ("A", "B", "C")
IDEAL = 1
"""`joint.J.model`: a constraint, whose clearance counts for nothing."""


def placements(study: pandas.DataFrame) -> pandas.DataFrame:
    """Results with the radial clearances [m] of joints A, B and C as their index, 0 of an ideal joint.

    Columns are the quantities that the study keeps, and `status`. Joints whose model the study does not vary have the
    clearance of its table.
    """
    sizes = {}
    for joint in JOINTS:
        name = f"joint.{joint}.clearance"
        if name not in study:
            raise KeyError(f"the study has no `{name}`: the clearances of joints A, B and C are in its table or grid")
        size = study[name]
        model = f"joint.{joint}.model"
        sizes[joint] = size.where(study[model] != IDEAL, 0.0) if model in study else size
    kept = study[[name for name in study.columns if not name.startswith("joint.")]]
    return kept.set_index(pandas.MultiIndex.from_frame(pandas.DataFrame(sizes))).sort_index()
