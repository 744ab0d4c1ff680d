"""The certificate proves no packing that is no equilibrium: by hand, and at random."""

from copy import deepcopy
from functools import cache
from typing import Any

import flint
import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.errors import UndecidedError
from force_diffusion.numeric.arithmetic.systems import Balls
from force_diffusion.numeric.unilateral import certificate
from force_diffusion.numeric.unilateral.certificate import certify, smallest_singular_value
from force_diffusion.numeric.unilateral.grains import Grains
from force_diffusion.numeric.unilateral.network import Frame, Network, UnfinishedError
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import csc_array, eye_array, random_array
from scipy.sparse.linalg import splu

import force_diffusion as fd
from tests.numeric.unilateral.packings import Packing, must_hold, network_of, packing_of, strip

BITS = 256


def pile(*, period: str = "12") -> Packing:
    """A bead on two of the base, in two triangles of sides 3, 4 and 5; forces are 5/8."""
    return Packing(
        period,
        2,
        ["2.5", "2.5", "2.5"],
        [["0", "0"], ["0", "0"], ["0", "-1"]],
        [["0", "0"], ["6", "0"], ["3", "4"]],
        [[2, 0], [2, 1]],
    )


def more(x: str = "3", y: str = "20", *, radius: str = "1", load: str = "0", **of: Any) -> Packing:
    """The pile, and a bead that touches nothing."""
    packing = pile(**of)
    packing.radii.append(radius)
    packing.loads.append(["0", load])
    packing.centres.append([x, y])
    return packing


def changed(key: str, at: int, value: Any) -> Packing:
    packing = pile()
    getattr(packing, key)[at] = value
    return packing


def third_base_bead(x: str, y: str) -> Packing:
    packing = more(x, y, radius="2.5")
    for column in (packing.radii, packing.loads, packing.centres):
        column.insert(2, column.pop())
    packing.fixed, packing.contacts = 3, [[3, 0], [3, 1]]
    return packing


def certified(packing: Packing) -> Network:
    """Prove a packing by the certificate, to which contacts are pairs with a free bead.

    Raises what that raises.
    """
    pairs = np.array([sorted(pair, reverse=True) for pair in packing.contacts]).reshape(-1, 2)
    if (pairs[:, 0] == pairs[:, 1]).any() or (pairs[:, 0] < packing.fixed).any():
        raise UnfinishedError("no contact")
    with flint.ctx.workprec(BITS), np.errstate(all="ignore"):

        def balls(values: Any) -> np.ndarray:
            return np.asarray(np.frompyfunc(flint.arb, 1, 1)(np.array(values, dtype=object)))

        load, radii = balls(packing.loads), balls(packing.radii)
        base = balls(packing.centres[: packing.fixed])
        centres, sizes = (np.array(of, dtype=float) for of in (packing.centres, packing.radii))
        period = float(packing.period)
        grains = Grains(centres, sizes, period, load.astype(float), packing.fixed)
        frame = Frame(radii, base, flint.arb(packing.period), load)
        return certify(grains, pairs, frame, Balls(BITS))


def refused(packing: Packing) -> str:
    """Say why the certificate does not prove a packing."""
    try:
        certified(packing)
    except (UnfinishedError, UndecidedError) as error:
        return str(error)
    return ""


def test_what_stands_is_proved():
    for packing in (
        *(pile(), third_base_bead("3", "-5"), more(), more(load="-0.0e5")),
        *(more("3", "7.75"), more("3", "0.5", radius="0.4")),
        *(changed("loads", 2, ["0", "-2"]), changed("centres", 2, ["15", "4"])),
    ):
        must_hold(packing)
        assert refused(packing) == "", packing


def test_what_is_certified_of_the_pile():
    """5/8 by hand; a bead of radius 1, 3.75 above one of radius 2.5."""
    network = certified(pile())
    assert [float(force) for force in network.forces] == pytest.approx([5 / 8] * 2)
    assert certified(more("3", "7.75")).smallest_gap == pytest.approx(0.25)
    assert certified(more()).rattlers.tolist() == [3]


def test_forces_below_the_rounding_of_others_are_certified():
    """The load points at bead 0, but for 1e-18: half of its 5/4 remains for bead 1."""
    packing = changed("loads", 2, ["-0.6", "-0.800000000000000001"])
    assert float(min(certified(packing).forces, key=float)) == pytest.approx(0.625e-18)
    pulls = changed("loads", 2, ["-0.6", "-0.799999999999999999"])
    assert refused(pulls)


@pytest.mark.parametrize(
    ("load", "fourth", "contacts"),
    [(["0", "-1"], "14.2", [[5, 2], [5, 3]]), (["-0.6", "-0.8"], "14.5", [[5, 2], [5, 4]])],
)
def test_of_beads_that_touch_without_force_nothing_is_proved(load, fourth, contacts):
    """Two beads side by side, each on two of the base, in triangles of sides 3, 4 and 5."""
    packing = Packing(
        "30",
        4,
        ["0.9"] * 4 + ["4.1"] * 2,
        [["0", "0"]] * 4 + [["0", "-1"], load],
        [[x, "0"] for x in ("0", "6", "8.2", fourth)] + [["3", "4"], ["11.2", "4"]],
        [[4, 0], [4, 1], *contacts],
    )
    assert refused(packing)
    packing.centres = [[x, "0"] for x in ("0", "6", "9", "15")] + [["3", "4"], ["12", "4"]]
    packing.contacts, packing.loads[5] = [[4, 0], [4, 1], [5, 2], [5, 3]], ["0", "-1"]
    assert refused(packing) == ""  # a little further apart


@pytest.mark.parametrize(
    "packing",
    [
        more(load="-5"),
        more(load="1e-9999"),
        more(radius="-1"),
        more(radius="3.1"),  # above a quarter of the period
        more("3", "7.4"),
        more("27", "7.4"),  # two periods away
        more("3", "-50"),
        third_base_bead("1", "-2"),
        third_base_bead("9", "0"),
        changed("radii", 2, "-2.5"),
        pile(period="-12"),
        pile(period="1e-9999"),
        pile(period="9.9"),
        changed("loads", 2, ["0", "0"]),
        changed("loads", 2, ["-5", "0"]),
        changed("contacts", 1, [1, 0]),
    ],
)
def test_what_is_no_equilibrium_is_not_proved(packing):
    assert refused(packing)


KINDS = ("pile", "pressed", "rattlers")


@cache
def example(kind: str) -> Packing:
    """The pile, or packings that ``run`` certified, with and without rattlers."""
    if kind == "pile":
        return pile()
    load = fd.PointLoad(at=[0, 4]) if kind == "rattlers" else fd.SurfaceLoad()
    return packing_of(network_of(strip(height=4, width=6, std=0.04, seed=2, load=load).run()))


@pytest.mark.parametrize("kind", KINDS)
def test_the_packings_to_be_changed_are_proved(kind):
    packing = example(kind)
    assert refused(packing) == ""
    beads = {bead for pair in packing.contacts for bead in pair}
    assert (len(beads) < len(packing.radii)) == (kind == "rattlers")
    must_hold(packing)


amounts = st.builds(
    "{}{}e{}".format, st.sampled_from(["", "-"]), st.integers(1, 9), st.integers(-16, 3)
)


def plus(value: str, amount: str) -> str:
    """A sum of decimals, rounded: the first is lost where it is far smaller."""
    return repr(float(value) + float(amount))


@st.composite
def changes(draw: st.DrawFn, kind: str) -> Packing:
    """One or two changes of a load, a radius, a centre, the contacts, the period, or a new bead."""
    packing = deepcopy(example(kind))
    for _ in range(draw(st.integers(1, 2))):
        bead, other = (draw(st.integers(0, len(packing.radii) - 1)) for _ in range(2))
        axis, amount = draw(st.integers(0, 1)), draw(amounts)
        size, period, contacts = float(packing.radii[bead]), packing.period, packing.contacts
        which = draw(st.integers(0, max(len(contacts) - 1, 0)))
        match draw(st.sampled_from(["load", "radius", "centre", "contact", "period", "bead"])):
            case "load":
                load = packing.loads[bead]
                load[axis] = draw(st.sampled_from([amount, "0", plus(load[axis], amount)]))
            case "radius":
                sizes = ["0", repr(-size), amount, plus(repr(size), amount)]
                packing.radii[bead] = draw(st.sampled_from(sizes))
            case "centre":
                moved = list(packing.centres[bead])
                moved[axis] = plus(moved[axis], amount)
                packing.centres[bead] = draw(st.sampled_from([moved, packing.centres[other][:]]))
            case "contact":
                pair, before, after = [bead, other], contacts[:which], contacts[which + 1 :]
                new = [[], [pair], [*contacts[which : which + 1], pair], contacts[which:][:1] * 2]
                packing.contacts = [*before, *draw(st.sampled_from(new)), *after]
            case "period":
                new_periods = ["0", repr(-float(period)), repr(2 * size), repr(3.9 * size), amount]
                packing.period = draw(st.sampled_from([*new_periods, plus(period, amount)]))
            case "bead":
                packing.radii.append(draw(st.sampled_from(["0.3", "1", amount])))
                packing.loads.append(["0", draw(st.sampled_from(["0", amount]))])
                packing.centres.append([draw(amounts), draw(amounts)])
    return packing


@pytest.mark.parametrize("kind", KINDS)
@given(data=st.data())
def test_no_change_makes_a_proof_of_what_is_no_equilibrium(kind, data):
    """The certificate moves beads by Newton's steps first: what it proves is where they end."""
    try:
        network = certified(data.draw(changes(kind)))
    except (UnfinishedError, UndecidedError):
        return
    must_hold(packing_of(network))


Array = np.ndarray


def bound(dense: Array, near: Array | None = None) -> float:
    """Bound it; ``near``: the matrix whose factors choose the shift, by default the same."""
    factors = splu(csc_array(dense if near is None else near))
    return smallest_singular_value(csc_array(dense), factors)


def matrix(n: int, seed: int) -> Array:
    sparse = random_array((n, n), density=min(1, 4 / n), rng=np.random.default_rng(seed))
    return np.asarray(sparse.toarray() + np.eye(n))


@pytest.mark.parametrize("n", [1, 2, 5, 40, 300])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_smallest_singular_value_is_bounded_from_below_and_well(n, seed):
    dense = matrix(n, seed)
    exact = np.linalg.svd(dense, compute_uv=False)[-1]
    assert exact / 4 < bound(dense) <= exact


@pytest.mark.parametrize("wrong", [1e3, 1e-2])
def test_the_bound_holds_whatever_chose_the_shift(wrong):
    """Factors of a larger matrix give too large a shift, which is made smaller until it holds."""
    dense = matrix(40, 1)
    assert bound(dense, wrong * dense) <= np.linalg.svd(dense, compute_uv=False)[-1]


def test_the_bound_holds_whatever_the_factorisation(monkeypatch):
    """Factors of another matrix leave more than the shift, and prove nothing."""

    def wrong(shifted: Any, *how: Any, **options: Any) -> Any:
        return splu((shifted + eye_array(shifted.shape[0])).tocsc(), *how, **options)

    monkeypatch.setattr(certificate, "splu", wrong)
    with pytest.raises(UndecidedError):
        bound(matrix(40, 1) * 0.1)


@pytest.mark.parametrize("smallest", [0.0, 1e-12, 1e-9])
def test_nothing_is_bounded_where_rounding_is_larger(smallest):
    """Its square is below 1e-16, the rounding of the others'."""
    turn = np.linalg.qr(np.random.default_rng(1).standard_normal((8, 8)))[0]
    dense = turn @ np.diag([*[1.0] * 7, smallest]) @ turn.T
    with pytest.raises(UndecidedError, match="too inaccurate to bound"):
        bound(dense, np.eye(8) if smallest == 0 else dense)
