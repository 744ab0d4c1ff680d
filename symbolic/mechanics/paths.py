"""Downward paths of a contact force with no branch or with one.

A path enters at the contact (k−1, l−1) → (k, l) along n⁺. It makes p further steps straight
down along n⁺, then, if it branches, q steps along n⁻. A contact is named by its lower bead.
"""

import sympy

from ..symbols import i, j, k, l, n, p, q

ENTRY = (k - 1, l - 1)
"""Lower bead of the contact through which the force comes in."""


def straight_end(steps: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
    """Lower bead of the contact reached after ``steps`` straight steps."""
    return ENTRY[0] - steps, ENTRY[1] - steps


def branched_end() -> tuple[sympy.Expr, sympy.Expr]:
    """Lower bead of the contact reached after p straight steps, a branch and q steps along n⁻."""
    across, layer = straight_end(p)
    return across + q, layer - q


BRANCH_COUNT = ((l - j) - (k - i)) / 2
"""The paper's n: the number of steps from the branch down to the contact."""

BY_BRANCH = {k: i + 1 + p - n, l: j + 1 + p + n}
"""The entry's indices in terms of (i, j), of p and of n = q."""

IN_CONE = {k: i + p - q, l: j + p + q}
"""The loaded bead (k, l) seen from (i, j), p steps along n⁺ and q along n⁻ below it."""
