"""What becomes of forces and of the response beyond the first tension: measured, with two errors.

Run with ``python benchmarks/tensionless_forces.py --of-critical 0.5 1 2``. Strips of M layers of 2M
beads come to rest by linear programs; those that do not are counted and left out. Printed are, with
two standard errors over packings: σ_f/⟨f⟩ at four heights, shares of forces beyond multiples of the
mean, and the response to a small load on one bead of the surface, while no contact opens: of the
vertical forces p that base beads then bear besides, Σ|p| over the load, 1 where none is relieved,
and the mean of Σp over the beads at a distance x, in units of that of the ordered packing's beads.
"""

import argparse
from fractions import Fraction

import numpy as np
from force_diffusion.numeric.arithmetic.systems import Array
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.planning.planner import plan
from force_diffusion.numeric.unilateral.grains import Grains
from force_diffusion.numeric.unilateral.network import UnfinishedError
from force_diffusion.numeric.unilateral.relaxation import balanced, settle
from scipy.sparse.linalg import splu

import force_diffusion as fd

HEIGHTS = (0.0, 0.25, 0.5, 0.75)  # z = j/M
TIMES = (1, 2, 3, 4)
DISTANCES = np.arange(0, 2.25, 0.25)  # up to half a strip of 2M beads


def response(grains: Grains, pairs: Array) -> tuple[Array, Array]:
    """Give Σ|p| of each bead of the surface, were it loaded, and their mean Σp by ``DISTANCES``."""
    W, backbone = grains.fixed, grains.backbone(pairs)
    place = grains.coordinates(backbone)
    factors = splu(grains.jacobian(pairs)[:, place].tocsc())
    surface = [b for b in backbone if b >= len(grains.radii) - W]
    down = np.zeros((grains.unknowns, len(surface)))
    down[grains.coordinates(np.array(surface))[1::2], np.arange(len(surface))] = -1
    change = factors.solve(-down[place], trans="T")
    base = pairs[:, 1] < W
    push = grains.directions(pairs[base])[:, 1:] * change[base]
    borne = np.zeros((W, len(surface)))
    np.add.at(borne, pairs[base][:, 1], push)
    x = grains.x[:W, :1] - grains.x[surface, 0]
    x -= grains.period * np.round(x / grains.period)
    nearest = np.round(np.abs(x) / (grains.period / 4) / DISTANCES[1]).astype(int)
    profile = np.bincount(nearest.ravel(), borne.ravel(), len(DISTANCES)) / len(surface)
    return np.abs(borne).sum(axis=0), profile


def relative_std(sums: Array) -> Array:
    """Give σ_f/⟨f⟩ from counts, totals and squares summed over packings, (3, heights)."""
    counts, totals, squares = sums
    mean = totals / counts
    return np.asarray(np.sqrt(squares / counts - mean**2) / mean)


def errors(values: Array) -> Array:
    """Give two standard errors of the means over packings."""
    return np.asarray(2 * values.std(axis=0, ddof=1) / np.sqrt(len(values)))


def measured(load: fd.Load, spacing: float, M: int, of_critical: float, packings: int) -> None:
    """Print a row."""
    std = Fraction(int((of_critical / M) ** 1.5 * 10**9), 10**9)
    sums, beyond, absolute, profiles, left_out = [], [], [], [], 0
    for number in range(packings):
        scene = fd.Scene(
            packing=fd.Packing(height=M, width=2 * M, spacing=spacing),
            disorder=fd.Disorder(kind="uniform", relative_std=std, seed=number),
            load=load,
            effects=fd.Effects(contacts="unilateral"),
            ask=fd.Ask(quantity="contact_forces"),
        )
        problem = plan(scene).problem
        try:
            settled = settle(problem, 0, Work())
        except UnfinishedError:
            left_out += 1
            continue
        grains, pairs = settled.grains, settled.contacts
        forces = balanced(grains, pairs)
        layer = pairs[:, 1] // grains.fixed
        groups = [forces[layer == round(z * M)] for z in HEIGHTS]
        sums.append([[len(g) for g in groups], [g.sum() for g in groups],
                     [(g**2).sum() for g in groups]])  # fmt: skip
        beyond.append([(forces > k * forces.mean()).mean() for k in TIMES])
        sizes, profile = response(grains, pairs)
        absolute.append(np.median(sizes))
        profiles.append(profile)
    every = np.array(sums, dtype=float)
    without = np.array([relative_std(every.sum(axis=0) - own) for own in every])
    jackknife = np.sqrt(len(every) - 1) * without.std(axis=0)
    shares, logs, profile = np.array(beyond), np.log10(absolute)[:, None], np.array(profiles)
    typical = float(logs.mean())
    cells = [
        M, of_critical, f"{len(sums)}, {left_out}",
        *(f"{s:.2f} ± {2 * e:.2f}"
          for s, e in zip(relative_std(every.sum(axis=0)), jackknife, strict=True)),
        *(f"{s:.3f} ± {e:.3f}" for s, e in zip(shares.mean(axis=0), errors(shares), strict=True)),
        f"{10**typical:.3g} ×÷ {10 ** float(errors(logs)[0]):.2g}",
        *(f"{p:.2f} ± {e:.2f}" for p, e in zip(profile.mean(axis=0), errors(profile), strict=True)),
    ]  # fmt: skip
    print("|", " | ".join(map(str, cells)), "|", flush=True)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--of-critical", type=float, nargs="+", default=[0.25, 0.5, 1, 2])
    parser.add_argument("--height", type=int, nargs="+", default=[16])
    parser.add_argument("--packings", type=int, default=24)
    parser.add_argument("--load", choices=["surface", "bulk"], default="surface")
    parser.add_argument("--angle", type=float, default=0, help="of a surface load, degrees")
    parser.add_argument("--spacing", type=float, default=3, help="of beads in a layer, in r")
    options = parser.parse_args()
    surface = options.load == "surface"
    load = fd.SurfaceLoad(angle_deg=options.angle) if surface else fd.BulkLoad()
    names = [f"σ_f/⟨f⟩ at z = {z:g}" for z in HEIGHTS] + [f"f > {k} ⟨f⟩" for k in TIMES]
    names += ["median Σ|p|", *(f"Σp at x = {d:g}" for d in DISTANCES)]
    head = ["M", "M/M*", "packings, unfinished", *names]
    print(load, f"s = {options.spacing:g} r")
    print("|", " | ".join(head), "|\n|", "|".join("---" for _ in head), "|")
    for M in options.height:
        for of_critical in options.of_critical:
            measured(load, options.spacing, M, of_critical, options.packings)


if __name__ == "__main__":
    main()
