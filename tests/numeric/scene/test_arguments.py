"""Small things that users tripped over: what is wrong is said in their words."""

import math
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import flint
import mpmath
import numpy as np
import pytest
import sympy
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError

import force_diffusion as fd
from force_diffusion.__main__ import main

SCENE = fd.Scene(
    packing=fd.Packing(height=4, width=8),
    disorder=fd.Disorder(kind="uniform", relative_std=1e-4),
    ask=fd.Ask(quantity="profile"),
)


@pytest.mark.parametrize(
    "wrong",
    [
        {"realisations": "a"}, {"realisations": 10.5}, {"workers": "x"}, {"until": "a"},
        {"confidence": "a"}, {"reach": "a"}, {"store": 5},
    ],
)  # fmt: skip
def test_wrong_types_for_an_ensemble(wrong: dict[str, Any]) -> None:
    (name,) = wrong
    with pytest.raises(ForceDiffusionError, match=rf"^{name} = "):
        fd.ensemble(SCENE, **{"realisations": 10, **wrong})


EXACT = [
    *(Fraction(16, 5), Decimal("3.2"), 3.2, np.float64(3.2)),
    *(sympy.Rational(16, 5), flint.fmpq(16, 5)),
    *(3, Fraction(3), np.int64(3), np.uint8(3), sympy.Integer(3), flint.fmpz(3), flint.fmpq(3)),
]


@pytest.mark.parametrize("at", range(len(EXACT)))
def test_exact_numbers_are_taken(at: int) -> None:
    expected = Fraction(16, 5) if at < 6 else Fraction(3)
    delta = 1e-3 * np.random.default_rng(1).uniform(-1, 1, (3, 6))
    assert fd.Packing(height=2, spacing=EXACT[at]).spacing == expected
    assert fd.solve(delta_r=delta, spacing=EXACT[at]).scene.packing.spacing == expected


REFUSED = [  # longer than float64, not one number, or too long
    *(mpmath.mpf("3.2"), mpmath.iv.mpf([3, 3.5]), mpmath.mpc(3, 0), sympy.Float("3.2", 40)),
    *(sympy.sqrt(10), sympy.oo, np.longdouble("3.2"), np.float32(3.2), flint.arb("3.2"), 3 + 0j),
    *(True, Decimal("1E+9999999"), Decimal("1E-9999999"), Decimal("NaN"), math.nan, 10**6000),
    *(Fraction(10**6000, 3), Fraction(1, 10**20000), flint.fmpq(10**6000)),
]


@pytest.mark.parametrize("number", REFUSED, ids=range(len(REFUSED)))
def test_other_numbers_are_refused_in_words(number: Any) -> None:
    for name in ("spacing", "tolerance"):
        with pytest.raises(fd.SceneError, match=rf"^{name} = .*: must (be|have) "):
            fd.solve(delta_r=np.zeros((3, 6)), **{name: number})


LONGER = [
    [[1, Fraction(4, 3)]] * 2, [[mpmath.mpf(1)] * 2] * 2, [[Decimal("1.1")] * 2] * 2,
    [[mpmath.iv.mpf([1, 2])] * 2] * 2, np.full((2, 3), 1 + np.longdouble(2) ** -60),
    np.full((2, 3), 2**53 + 1), np.full((2, 3), True),
]  # fmt: skip


@pytest.mark.parametrize("radii", LONGER, ids=range(len(LONGER)))
def test_radii_are_not_cut_in_silence(radii: Any) -> None:
    with pytest.raises(fd.SceneError, match=r"(?s)^radii = .*by \.astype\(float\)"):
        fd.solve(radii)


@pytest.mark.parametrize("kind", [np.longdouble, np.float32, np.float16, np.int8, np.uint64])
def test_radii_that_float64_holds_are_taken(kind: Any) -> None:
    radii = np.full((3, 6), 64).astype(kind)
    assert fd.solve(radii, radius=64).scene.disorder.values.dtype == np.float64  # type: ignore[union-attr]


@pytest.mark.parametrize("wrong", [{"heights": 5}, {"realisations": "a"}, {"realisations": -1}])
def test_wrong_types_for_a_figure(wrong: dict[str, Any]) -> None:
    (name,) = wrong
    with pytest.raises(fd.SceneError, match=rf"^{name} = "):
        fd.figure(3, **wrong)


def test_a_huge_number_can_be_shown() -> None:
    assert "radius=1e+4999" in repr(fd.Packing(height=4, width=9, radius=10**4999))
    assert "radius=2.5" in repr(fd.Packing(height=4, width=9, radius=2.5))


def test_a_file_that_is_no_scene_is_named(tmp_path: Path, capsys: Any) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("root:x:0")
    with pytest.raises(fd.SceneError, match=r"mine\.toml: is no scene, which is a TOML file"):
        fd.read_scene(path)
    for name in (str(path), "nope.toml"):
        assert main(["run", name]) == 2
        assert capsys.readouterr().err.count(Path(name).name) == 1
    path.write_text("packing = {height = 0}\nask = {quantity = 'profile'}")
    assert main(["run", str(path)]) == 2
    assert capsys.readouterr().err.startswith("force-diffusion: mine.toml: packing.height = 0")


def test_a_load_above_the_packing_is_told_so() -> None:
    with pytest.raises(fd.SceneError, match="j must be from 1, above the base, to 4, the surface"):
        fd.Scene(
            packing=fd.Packing(height=4, width=8),
            load=fd.PointLoad(at=(3, 8)),
            ask=fd.Ask(quantity="contact_forces"),
        )


def test_solve_names_its_own_arguments() -> None:
    radii = 1 + 1e-3 * np.random.default_rng(1).uniform(-1, 1, (5, 12))
    wrong: dict[str, Any]
    for wrong, says in (
        ({"radii": radii, "spacing": 9}, r"^spacing = 9: .* \(it is about 8\.99\d* r\)"),
        ({"radii": radii, "radius": 9}, "^radius = 9"),
        ({"radii": "a"}, "^radii = "),
        ({"delta_r": [["a"]]}, "^delta_r = "),
    ):
        with pytest.raises(fd.SceneError, match=says):
            fd.solve(**wrong)


def test_what_is_odd_about_a_batch_names_the_packing() -> None:
    radii = 1 + 1e-3 * np.random.default_rng(1).uniform(-1, 1, (4, 5, 12))
    radii[2] += 0.13 * np.random.default_rng(2).uniform(-1, 1, (5, 12))
    physical = fd.solve(radii).forces.data()["physical"]
    assert physical["smallest_gap_realisation"] == 2
    assert physical["first_tensile"]["realisation"] == 2
    radii[3, 0, 5] = 5.0
    with pytest.raises(ForceDiffusionError) as caught:
        fd.solve(radii)
    assert caught.value.__notes__ == ["packing 3"]
