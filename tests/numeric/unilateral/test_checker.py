"""``check-packings`` proves no packing that is no equilibrium: by hand, and by random changes."""

import copy
import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd

Packing = dict[str, Any]


def said(packing: Packing) -> fd.Verdict:
    with TemporaryDirectory() as folder:
        path = Path(folder, "packings.json")
        path.write_text(json.dumps({"format": "force-diffusion packings 1", "packings": [packing]}))
        (verdict,) = fd.check_packings(path)
    return verdict


def pile(*, period: str = "12") -> Packing:
    """A bead on two of the base, in two triangles of sides 3, 4 and 5; forces are 5/8."""
    return {
        "period": period,
        "fixed": 2,
        "radii": ["2.5", "2.5", "2.5"],
        "loads": [["0", "0"], ["0", "0"], ["0", "-1"]],
        "centres": [["0", "0"], ["6", "0"], ["3", "4"]],
        "contacts": [[2, 0], [2, 1]],
    }


def more(x: str = "3", y: str = "20", *, radius: str = "1", load: str = "0", **of: Any) -> Packing:
    """The pile, and a bead that touches nothing."""
    packing = pile(**of)
    packing["radii"].append(radius)
    packing["loads"].append(["0", load])
    packing["centres"].append([x, y])
    return packing


def changed(key: str, at: int, value: Any) -> Packing:
    packing = pile()
    packing[key][at] = value
    return packing


def third_base_bead(x: str, y: str) -> Packing:
    packing = more(x, y, radius="2.5")
    for key in ("radii", "loads", "centres"):
        packing[key].insert(2, packing[key].pop())
    return packing | {"fixed": 3, "contacts": [[3, 0], [3, 1]]}


def test_what_stands_is_proved() -> None:
    verdict = said(pile())
    assert verdict.proved
    assert verdict.smallest_force == pytest.approx(5 / 8)
    assert verdict.smallest_gap == pytest.approx(1)  # of those that it measures
    assert said(more("3", "7.75")).smallest_gap == pytest.approx(0.25)  # of radii 2.5 and 1
    assert said(third_base_bead("3", "-5")).proved
    for bead in (more(), more(load="-0.0e5"), more("3", "0.5", radius="0.4")):
        assert said(bead).proved, bead
        assert said(bead).rattlers == 1


def test_strict_is_said_of_beads_that_are_held_alone() -> None:
    """The bead in the air could go anywhere, at no cost."""
    found = str(said(more()))
    assert "a strict local minimum in the coordinates of beads that contacts hold" in found
    assert "1 rattlers, whose places are some of many" in found


def test_forces_below_the_rounding_of_others_are_proved() -> None:
    """The load points at bead 0, but for 1e-18: half of its 5/4 remains for bead 1."""
    verdict = said(changed("loads", 2, ["-0.6", "-0.800000000000000001"]))
    assert verdict.proved
    assert verdict.smallest_force == pytest.approx(0.625e-18)
    assert not said(changed("loads", 2, ["-0.6", "-0.799999999999999999"])).proved


@pytest.mark.parametrize(
    ("load", "fourth", "contacts", "why"),
    [
        (
            ["0", "-1"],
            "14.2",
            [[5, 2], [5, 3]],
            "beads 4 and 5 overlap, or are not shown to be apart",
        ),
        (["-0.6", "-0.8"], "14.5", [[5, 2], [5, 4]], "may not be positive"),
    ],
)
def test_of_beads_that_touch_without_force_nothing_is_proved(
    load: list[str], fourth: str, contacts: list[list[int]], why: str
) -> None:
    """Two beads side by side, each on two of the base, in triangles of sides 3, 4 and 5."""
    packing: Packing = {
        "period": "30",
        "fixed": 4,
        "radii": ["0.9"] * 4 + ["4.1"] * 2,
        "loads": [["0", "0"]] * 4 + [["0", "-1"], load],
        "centres": [[x, "0"] for x in ("0", "6", "8.2", fourth)] + [["3", "4"], ["11.2", "4"]],
        "contacts": [[4, 0], [4, 1], *contacts],
    }
    verdict = said(packing)
    assert not verdict.proved
    assert why in verdict.why
    assert "of beads that touch without force nothing can be proved" in verdict.why
    packing["centres"] = [*packing["centres"][:2], ["9", "0"], ["15", "0"], ["3", "4"], ["12", "4"]]
    packing["contacts"] = [[4, 0], [4, 1], [5, 2], [5, 3]]
    packing["loads"][5] = ["0", "-1"]
    assert said(packing).proved  # a little further apart


@pytest.mark.parametrize(
    ("packing", "why"),
    [
        (more(load="-5"), "bead 3 bears a load"),
        (more(load="-1000"), "bead 3 bears a load"),
        (more(load="-1e-14"), "bead 3 bears a load"),
        (more(load="1e-9999"), "bead 3 bears a load"),
        (more(radius="-1"), "radius of bead 3"),
        (more(radius="0"), "radius of bead 3"),
        (more(radius="-1e-9999"), "radius of bead 3"),
        (more(radius="3.1"), "the period"),  # above a quarter of the period
        (more(radius="6.5"), "the period"),  # overlaps its own image
        (more("3", "7.4"), "beads 2 and 3 overlap"),
        (more("27", "7.4"), "beads 2 and 3 overlap"),  # two periods away
        (more("3", "-50"), "below the base"),
        (third_base_bead("1", "-2"), "beads 0 and 2 overlap"),
        (third_base_bead("9", "0"), "beads 0 and 2 overlap"),
        (changed("radii", 2, "-2.5"), "radius of bead 2"),
        (pile(period="-9"), "the period"),
        (pile(period="-12"), "the period"),
        (pile(period="0"), "the period"),
        (pile(period="1e-9999"), "the period"),
        (pile(period="9.9"), "the period"),
        (pile(period="1e9999"), "a number"),
        (changed("centres", 2, ["3e9999", "4"]), "a number"),
        (changed("loads", 2, ["0", "-1e9999"]), "a number"),
        (changed("radii", 2, "1e9999"), "a number"),
        (changed("centres", 2, ["0", "0"]), "open or overlap"),
        (changed("loads", 2, ["0", "0"]), "the force"),
        (changed("loads", 2, ["0", "1"]), "the force"),
        (changed("loads", 2, ["-5", "0"]), "the force"),
        (changed("contacts", 1, [2, 2]), "itself"),
        (changed("contacts", 1, [1, 0]), "two beads of the base"),
    ],
)  # fmt: skip
def test_what_is_no_equilibrium_is_not_proved(packing: Packing, why: str) -> None:
    verdict = said(packing)
    assert not verdict.proved
    assert why in verdict.why


def test_a_bead_that_overlaps_its_own_image_is_not_proved() -> None:
    """The pile, five times smaller: a period of 2.4, and a bead in the air of radius 1.3."""
    packing = more("0.6", "20", radius="1.3", period="2.4")
    packing["radii"][:3] = ["0.5"] * 3
    packing["centres"][:3] = [["0", "0"], ["1.2", "0"], ["0.6", "0.8"]]
    assert not said(packing).proved
    packing["radii"][3] = "0.59"
    assert said(packing).proved


@pytest.mark.parametrize("contact", [[2, 0], [0, 2], [2, 3], [2, 10**30], [2, -1], [2, 0, 1]])
def test_contacts_that_are_none_make_no_file(contact: list[int]) -> None:
    with pytest.raises(fd.ForceDiffusionError, match=r"packings\.json"):
        said(changed("contacts", 1, contact))


@cache
def found(kind: str) -> str:
    """Packings that ``run`` proved, as JSON: with and without rattlers."""
    with TemporaryDirectory() as folder:
        rows = ["i,j,fx,fy", "0,4,0,-1.01", *(f"{i},4,0,-0.01" for i in range(2, 12, 2))]
        Path(folder, "loads.csv").write_text("\n".join(rows))
        rattling = fd.Load(kind="file", file="loads.csv")
        outcome = fd.Scene(
            packing=fd.Packing(height=4, width=6, allow_images=True),
            disorder=fd.Disorder(kind="uniform", relative_std=0.04, seed=2),
            load=rattling if kind == "rattlers" else fd.SurfaceLoad(),
            effects=fd.Effects(contacts="unilateral"),
            ask=fd.Ask(quantity="contact_forces"),
            folder=Path(folder),
        ).run()
    return json.dumps(outcome.packings()["packings"][0])


def known(kind: str) -> Packing:
    return pile() if kind == "pile" else dict(json.loads(found(kind)))


KINDS = ("pile", "pressed", "rattlers")


@pytest.mark.parametrize("kind", KINDS)
def test_the_packings_to_be_changed_are_proved(kind: str) -> None:
    verdict = said(known(kind))
    assert verdict.proved, verdict
    assert (verdict.rattlers > 0) == (kind == "rattlers")


@pytest.mark.parametrize("decimals", [7, 8, 9])
def test_centres_known_to_some_decimals_are_enough(decimals: int) -> None:
    """As those of programs whose discs are soft: more beads, and more decimals are lost."""
    outcome = fd.Scene(
        packing=fd.Packing(height=6, width=12, allow_images=True),
        disorder=fd.Disorder(kind="uniform", relative_std=0.03, seed=1),
        effects=fd.Effects(contacts="unilateral", protocol="linear-programs"),
        ask=fd.Ask(quantity="contact_forces"),
    ).run()
    (packing,) = outcome.packings()["packings"]
    exact = [list(centre) for centre in packing["centres"]]
    packing["centres"][packing["fixed"] :] = [
        [f"{float(v):.{decimals}f}" for v in centre] for centre in exact[packing["fixed"] :]
    ]
    verdict = said(packing)
    assert verdict.proved, verdict
    assert verdict.within is not None
    lost = [
        abs(float(a) - float(b))
        for a, b in zip(np.ravel(exact), np.ravel(packing["centres"]), strict=True)
    ]
    assert max(lost) <= verdict.within < 3 * max(lost)


amounts = st.builds(
    lambda sign, digits, power: f"{sign}{digits}e{power}",
    st.sampled_from(["", "-"]),
    st.integers(1, 9),
    st.integers(-16, 3),
)


def plus(value: str, amount: str) -> str:
    """A sum of decimals, rounded: the first is lost where it is far smaller."""
    return repr(float(value) + float(amount))


@st.composite
def changes(draw: st.DrawFn, kind: str) -> Packing:
    """One or two changes of a load, a radius, a centre, the contacts, the period, or a new bead."""
    packing = copy.deepcopy(known(kind))
    for _ in range(draw(st.integers(1, 2))):
        beads = len(packing["radii"])
        one, other = draw(st.integers(0, beads - 1)), draw(st.integers(0, beads - 1))
        axis, amount = draw(st.integers(0, 1)), draw(amounts)
        contacts = packing["contacts"]
        which = draw(st.integers(0, len(contacts) - 1)) if contacts else 0
        size = float(packing["radii"][one])
        match draw(st.sampled_from(["load", "radius", "centre", "contact", "period", "bead"])):
            case "load":
                packing["loads"][one][axis] = draw(
                    st.sampled_from([amount, "0", plus(packing["loads"][one][axis], amount)])
                )
            case "radius":
                sizes = ["0", repr(-size), amount, plus(repr(size), amount)]
                packing["radii"][one] = draw(st.sampled_from(sizes))
            case "centre":
                centre = packing["centres"][one]
                if draw(st.booleans()):
                    centre[axis] = plus(centre[axis], amount)
                else:
                    packing["centres"][one] = list(packing["centres"][other])
            case "contact":
                packing["contacts"] = draw(
                    st.sampled_from(
                        [
                            contacts[:which] + contacts[which + 1 :],
                            [*contacts, [one, other]],
                            [*contacts[:which], [one, other], *contacts[which + 1 :]],
                            [*contacts, *contacts[which : which + 1]],
                        ]
                    )
                )
            case "period":
                period = float(packing["period"])
                new = [0, -period, 2 * size, 3.9 * size, period + float(amount), float(amount)]
                packing["period"] = repr(draw(st.sampled_from(new)))
            case "bead":
                packing["radii"].append(draw(st.sampled_from(["0.3", "1", amount])))
                packing["loads"].append(["0", draw(st.sampled_from(["0", amount]))])
                place = [plus(v, draw(amounts)) for v in packing["centres"][one]]
                packing["centres"].append(place)
    return packing


def must_hold(packing: Packing) -> None:
    """What holds of every equilibrium near by, in float64: gaps of all images, and the balance.

    An exact packing lies within 2e-6 of the centres of the beads that contacts hold; where no
    other bead lies can be told to rounding.
    """
    x = np.array(packing["centres"], dtype=float)
    r = np.array(packing["radii"], dtype=float)
    load, period = np.array(packing["loads"], dtype=float), float(packing["period"])
    fixed, contacts = packing["fixed"], packing["contacts"]
    held = {bead for pair in contacts for bead in pair if bead >= fixed}
    assert period > 0
    assert (r > 0).all()
    assert (period > 2 * r).all()  # a bead and its image
    assert (x[fixed:, 1] > x[:fixed, 1].min() - 1e-5).all()
    touching = {frozenset(pair) for pair in contacts}
    assert all(len(pair) == 2 and max(pair) >= fixed for pair in touching)
    images = np.arange(-3, 4) + np.round((x[:, None, 0] - x[None, :, 0]) / period)[..., None]
    dx = x[:, None, None, 0] - x[None, :, None, 0] - images * period
    gaps = np.hypot(dx, (x[:, None, 1] - x[None, :, 1])[..., None]) - (r[:, None] + r)[..., None]
    rounding = 1e-13 * (np.abs(x).max() + period)
    for a in range(len(x)):
        for b in range(a):
            nearest = gaps[a, b].min()
            room = rounding + (1e-5 if held & {a, b} else 0)
            assert nearest > -room
            assert frozenset((a, b)) not in touching or abs(nearest) < room
    for bead in range(fixed, len(x)):
        assert bead in held or not load[bead].any(), bead
    balance = np.zeros((len(x), 2, len(contacts)))
    for k, (a, b) in enumerate(contacts):
        d = x[a] - x[b]
        d[0] -= period * np.round(d[0] / period)
        direction = d / np.hypot(*d)
        balance[a, :, k], balance[b, :, k] = direction, -direction
    rows = balance[fixed:].reshape(-1, len(contacts))
    forces, *_ = np.linalg.lstsq(rows, -load[fixed:].ravel(), rcond=None)
    scale = np.abs(load[fixed:]).max()
    assert scale > 0
    condition = np.linalg.cond(rows)
    assert np.abs(rows @ forces + load[fixed:].ravel()).max() < 1e-5 * condition * scale
    assert forces.min() > -1e-5 * condition * scale


@pytest.mark.parametrize("kind", KINDS)
@given(data=st.data())
def test_no_change_makes_a_proof_of_what_is_no_equilibrium(kind: str, data: Any) -> None:
    packing = data.draw(changes(kind))
    try:
        verdict = said(packing)
    except fd.ForceDiffusionError:
        return  # no file of packings: status 2
    if verdict.proved:
        must_hold(packing)


@pytest.mark.parametrize(
    "harmless",
    [
        lambda p: p.update(loads=[[x, plus(y, y)] for x, y in p["loads"]]),
        lambda p: p.update(contacts=[pair[::-1] for pair in p["contacts"][::-1]]),
        lambda p: p["centres"][-1].__setitem__(0, plus(p["centres"][-1][0], p["period"])),
    ],
)
def test_changes_that_keep_an_equilibrium_are_proved(harmless: Callable[[Packing], Any]) -> None:
    packing = pile()
    harmless(packing)
    must_hold(packing)
    assert said(packing).proved
