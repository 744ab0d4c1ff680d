"""How many modest packings without tension are found: the table on that page.

    python benchmarks/tensionless_shares.py --seeds 1000 1400

A line for each scene without an answer, then the shares. Seeds below 1000 were looked at while the
program was made.
"""

import argparse
from collections import Counter

import numpy as np

import force_diffusion as fd


def scene(seed: int) -> fd.Scene:
    """Draw a scene: M, W, M/M*, s, the load's angle, the law of radii, a bulk load or not."""
    draw = np.random.default_rng([27, seed])
    height = int(draw.integers(3, 11))
    width, of_critical = int(draw.integers(4, 2 * height + 1)), float(draw.uniform(0.4, 1.3))
    spacing, angle = round(float(draw.uniform(2.2, 3.3)), 3), round(float(draw.uniform(0, 45)), 2)
    kind = str(draw.choice(["uniform", "normal", "two-point"], p=[0.6, 0.2, 0.2]))
    load = fd.BulkLoad if draw.random() < 0.3 else fd.SurfaceLoad
    std = round((of_critical / height) ** 1.5, 5)
    return fd.Scene(
        packing=fd.Packing(height=height, width=width, spacing=spacing, allow_images=True),
        disorder=fd.Disorder(kind=kind, relative_std=std, seed=seed),  # type: ignore[arg-type]
        load=load(angle_deg=angle),
        effects=fd.Effects(contacts="unilateral"),
        ask=fd.Ask(quantity="contact_forces"),
    )


def main() -> None:
    """Print lines and shares."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, nargs=2, default=[1000, 1400])
    asked = parser.parse_args()
    counts: Counter[str] = Counter()
    for seed in range(*asked.seeds):
        try:
            ends = scene(seed).run().data()["network"]["rest"]
        except fd.ForceDiffusionError as error:
            ends = "no packing can stand" if "can stand" in str(error) else "not found"
            print(f"{seed}: {error}")
        counts[ends] += 1
    for ends, count in counts.most_common():
        print(f"{count} of {counts.total()} ({count / counts.total():.0%}): {ends}")


if __name__ == "__main__":
    main()
