"""Packings for these tests: by hand, of scenes, and changed; and what is no equilibrium."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import flint
import numpy as np
from force_diffusion.numeric.arithmetic.systems import Balls
from force_diffusion.numeric.unilateral.certificate import certify
from force_diffusion.numeric.unilateral.grains import Grains
from force_diffusion.numeric.unilateral.network import Frame, Network, UnfinishedError

import force_diffusion as fd
from tests.numeric.scenes import question

BITS = 256


@dataclass
class Packing:
    """Decimals, in units of r: the first ``fixed`` beads are the base."""

    period: str
    fixed: int
    radii: list[str]
    loads: list[list[str]]
    centres: list[list[str]]
    contacts: list[list[int]]


def strip(
    quantity: str = "contact_forces", *, height: int = 8, width: int = 16, std: float = 0.016,
    contacts: str = "unilateral", effects: dict[str, Any] | None = None, **more: Any,
) -> fd.Scene:  # fmt: skip
    """Give a strip in which contacts would pull (seed 1, and σ/r as it is here)."""
    effects = {"contacts": contacts, **(effects or {})}
    return question(quantity, height, width, std=std, effects=effects, **more)


def network_of(outcome: fd.Outcome) -> Network:
    """Give where beads came to rest."""
    assert outcome.answer.network is not None
    return outcome.answer.network


def packing_of(network: Network) -> Packing:
    """Give a packing to 60 digits."""

    def decimal(ball: Any) -> str:
        return str(ball.mid().str(60, radius=False))

    frame = network.frame
    return Packing(
        decimal(frame.period),
        network.width,
        [decimal(r) for r in frame.radii],
        [[decimal(v) for v in load] for load in frame.load],
        [[decimal(v) for v in centre] for centre in network.x],
        network.pairs.tolist(),
    )


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

        centres, fixed = np.array(packing.centres, dtype=float), packing.fixed
        load = balls(packing.loads)
        frame = Frame(
            balls(packing.radii), balls(packing.centres[:fixed]), flint.arb(packing.period), load
        )
        grains = Grains(
            centres,
            np.array(packing.radii, dtype=float),
            float(packing.period),
            load.astype(float),
            fixed,
        )
        return certify(grains, pairs, frame, Balls(BITS))


def must_hold(packing: Packing) -> tuple[float, np.ndarray]:
    """Find the smallest gap of beads that don't touch, and the forces, by floats and least squares.

    Raises ``AssertionError`` unless the packing rests, and no bead can move without work.
    """
    x = np.array(packing.centres, dtype=float)
    r = np.array(packing.radii, dtype=float)
    load, period = np.array(packing.loads, dtype=float), float(packing.period)
    fixed, contacts = packing.fixed, np.array(packing.contacts).reshape(-1, 2)
    held = np.isin(np.arange(len(x)), contacts) & (np.arange(len(x)) >= fixed)
    assert period > 0
    assert (r > 0).all()
    assert (period > 2 * r).all()  # a bead and its image
    assert (x[fixed:, 1] > x[:fixed, 1].min()).all()
    assert not load[fixed:][~held[fixed:]].any()
    assert (contacts.max(axis=1) >= fixed).all()
    apart = x[:, None] - x[None]
    apart[..., 0] -= period * np.round(apart[..., 0] / period)
    images = apart[..., 0, None] + period * np.arange(-1, 2)
    gaps = np.hypot(images, apart[..., 1, None]).min(axis=-1) - r[:, None] - r
    rounding = 1e-13 * (np.abs(x).max() + period)
    a, b = contacts.T
    assert np.abs(gaps[a, b]).max() < rounding
    gaps[a, b] = gaps[b, a] = np.inf
    np.fill_diagonal(gaps, np.inf)
    assert gaps.min() > -rounding
    direction = apart[a, b] / np.linalg.norm(apart[a, b], axis=1)[:, None]
    balance, number = np.zeros((len(x), 2, len(contacts))), np.arange(len(contacts))
    balance[a, :, number], balance[b, :, number] = direction, -direction
    rows, pushed = balance[held].reshape(-1, len(contacts)), load[held].ravel()
    assert rows.shape[0] == rows.shape[1]
    room = 1e-13 * np.linalg.cond(rows) * np.abs(pushed).max()
    forces = np.linalg.solve(rows, -pushed)
    assert forces.min() > -room
    return float(gaps.min()), forces
