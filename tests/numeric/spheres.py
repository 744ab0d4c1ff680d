"""Small scenes of spheres."""

from typing import Any

import force_diffusion as fd
from tests.numeric.scenes import question


def scene(
    quantity: str = "contact_forces", *, height: int = 2, width: int = 3, std: float = 1e-2,
    geometry: str = "exact", **more: Any,
) -> fd.Scene:  # fmt: skip
    return question(
        quantity, height, width, dimension=3, spacing=2.9, std=std, seed=5,
        effects={"geometry": geometry}, **more,
    )  # fmt: skip
