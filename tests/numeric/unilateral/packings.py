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
    quantity: str = "contact_forces", *, std: float = 0.016, seed: int = 1, **more: Any
) -> fd.Scene:
    """Give a strip in which contacts would pull (seed 1, and σ/r as it is here)."""
    effects = {"contacts": more.pop("contacts", "unilateral"), **more.pop("effects", {})}
    return fd.Scene(
        packing=fd.Packing(
            height=more.pop("height", 8), width=more.pop("width", 16), allow_images=True
        ),
        disorder=fd.Disorder(kind="uniform", relative_std=std, seed=seed),
        load=more.pop("load", fd.SurfaceLoad()),
        effects=fd.Effects(**effects),
        ask=fd.Ask(quantity=quantity, **more),
    )


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


def must_hold(packing: Packing) -> None:
    """Raise ``AssertionError`` unless this is an equilibrium, by floats and least squares."""
    x = np.array(packing.centres, dtype=float)
    r = np.array(packing.radii, dtype=float)
    load, period = np.array(packing.loads, dtype=float), float(packing.period)
    fixed, contacts = packing.fixed, packing.contacts
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
