"""Packings for these tests: by hand, of scenes, and changed; and what is no equilibrium."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from force_diffusion.numeric.unilateral.network import Network

import force_diffusion as fd
from tests.numeric.scenes import question


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


def must_hold(packing: Packing) -> tuple[float, np.ndarray]:
    """Find the smallest gap of beads that don't touch, and the forces, by floats and least squares.

    Raises ``AssertionError`` unless the packing rests, and no bead can move without work.
    """
    x = np.array(packing.centres, dtype=float)
    r = np.array(packing.radii, dtype=float)
    load, period = np.array(packing.loads, dtype=float), float(packing.period)
    fixed, contacts = packing.fixed, np.array(packing.contacts).reshape(-1, 2)
    supported = np.isin(np.arange(len(x)), contacts) & (np.arange(len(x)) >= fixed)
    assert period > 0
    assert (r > 0).all()
    assert (period > 2 * r).all()  # a bead and its image
    assert (x[fixed:, 1] > x[:fixed, 1].min()).all()
    assert not load[fixed:][~supported[fixed:]].any()
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
    rows, pushed = balance[supported].reshape(-1, len(contacts)), load[supported].ravel()
    assert rows.shape[0] == rows.shape[1]
    room = 1e-13 * np.linalg.cond(rows) * np.abs(pushed).max()
    forces = np.linalg.solve(rows, -pushed)
    assert forces.min() > -room
    return float(gaps.min()), forces
