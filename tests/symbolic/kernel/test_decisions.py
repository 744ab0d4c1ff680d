"""Rulings: the worst of several."""

import pytest
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, proved, refuted, undecided


@pytest.mark.parametrize(
    ("rulings", "worst"),
    [
        ((proved("a"), undecided("b"), refuted("c")), refuted("c")),
        ((proved("a"), undecided("b")), undecided("b")),
        ((proved("a"), proved("b"), proved("a")), proved("a; b")),
    ],
)
def test_one_bad_ruling_spoils_all(rulings: tuple[Ruling, ...], worst: Ruling) -> None:
    assert all_of(*rulings) == worst
    assert str(worst) == f"{worst.verdict}: {worst.note}"
