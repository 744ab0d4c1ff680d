"""The double Y: rays of force that run straight until a defect splits them in two.

J.-P. Bouchaud, P. Claudin, D. Levine and M. Otto, Eur. Phys. J. E 4, 451 (2001). (We take this to
be among the paper's references ``doubleY1`` to ``doubleY3``; its source has no bibliography.) Rays
don't meet: their merging, the other half of the name, is left out, which makes the response linear
in the load.

A ray of strength f along n runs an exponentially distributed length of mean λ, then splits into two
of directions n turned by ±θ. Force balance, f n = f' (n' + n''), gives each f' = f/(2 cos θ). The
load starts as two rays along n^±, half of it in each. Rays end at the base and at the surface; what
arrives at the surface would lift it, and the base bears that much more than the load. The mean
response is that of a single walker: at each split it takes either ray and the strength of both,
f/cos θ, which keeps ⟨f n_y⟩ exactly.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from ..arithmetic.systems import Array
from .packings import Table

SPLITTING_ANGLE = np.radians(20)
RAYS = 200_000
BINS = np.linspace(-4, 4, 101)


def walk(
    splits: float, tilt: float, angle: float, rays: int, seed: int
) -> tuple[Array, Array, Array]:
    """Follow rays to the base (depth 1) or the surface (depth 0), with λ = 1/``splits``.

    ``tilt`` is the angle of n^± from straight down, ``angle`` that of a split, both in radians.

    Gives, per ray, where it ended (x), whether at the base, and its vertical force f |n_y| there,
    in units of the load; shapes (rays,). The means over rays are what base and surface get.
    """
    generator = np.random.default_rng(seed)
    direction = np.where(np.arange(rays) % 2, tilt, -tilt)
    strength = np.full(rays, 1 / np.cos(tilt))
    x, depth = np.zeros(rays), np.zeros(rays)
    end, at_base, force = np.zeros(rays), np.zeros(rays, dtype=bool), np.zeros(rays)
    here = np.arange(rays)
    while here.size:
        run = generator.exponential(size=here.size) / splits if splits else np.full(here.size, 1e9)
        down = np.cos(direction[here])
        to = depth[here] + run * down
        leaves = (to >= 1) | (to <= 0)
        gone = here[leaves]
        wall = (to[leaves] >= 1).astype(float)
        end[gone] = x[gone] + (wall - depth[gone]) / down[leaves] * np.sin(direction[gone])
        at_base[gone] = wall > 0
        force[gone] = strength[gone] * np.abs(down[leaves])
        depth[here] = to
        x[here] += run * np.sin(direction[here])
        here = here[~leaves]
        direction[here] += np.where(generator.random(here.size) < 0.5, angle, -angle)
        strength[here] /= np.cos(angle)
    return end, at_base, force


def profile(splits: float, tilt: float, seed: int, rays: int = RAYS) -> Array:
    """Estimate the mean response at the base, H = ``splits`` λ: density over x/H in ``BINS``."""
    end, at_base, force = walk(splits, tilt, SPLITTING_ANGLE, rays, seed)
    density, _ = np.histogram(end, BINS, weights=np.where(at_base, force, 0.0))
    return np.asarray(density / rays / np.diff(BINS))


def profiles(tilt: float, seed: int) -> dict[float, Array]:
    """Responses by H/λ from shallow (two peaks, along the cone) to deep (one, broad)."""
    return {splits: profile(splits, tilt, seed) for splits in (0.5, 2, 8)}


def table(found: Mapping[float, Array]) -> Table:
    """Give one row a bin."""
    return {
        "depth_over_splitting_length": np.repeat(list(found), len(BINS) - 1),
        "x_low": np.tile(BINS[:-1], len(found)),
        "x_high": np.tile(BINS[1:], len(found)),
        "density": np.concatenate(list(found.values())),
    }


def draw(axes: Axes, profiles: Mapping[float, Array], slope: float) -> None:
    """Draw responses over the horizontal position, and the cone of the packing, at ±``slope``."""
    looks: Any = ("-", (0, (5, 2)), (0, (1, 1.2)))
    for c, (splits, dashes) in enumerate(zip(profiles, looks, strict=True)):
        name = rf"$H={splits:g}\,\lambda$"
        axes.stairs(profiles[splits], BINS, color=f"C{c}", ls=dashes, lw=1, label=name)
    for side, label in ((-slope, None), (slope, "the packing's cone")):
        axes.axvline(side, color="0.6", ls=(0, (1, 1.5)), lw=0.7, zorder=0.5, label=label)
    axes.set(xlabel="horizontal position $x/H$", xlim=(-3, 3))
    axes.set_ylabel(r"mean response $H\,p(x)\,/\,f^{\rm load}$")
    axes.set_ylim(bottom=0)
    axes.legend(loc="upper center", title="double Y")
