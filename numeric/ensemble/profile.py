"""σ_f layer by layer over an ensemble, for figures and for work of one's own."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..arithmetic.systems import Array
from ..scene.scene import Scene
from ..scene.sections import SceneError
from .asked import measurement
from .run import Executor, run
from .scene_key import ensemble_key
from .store import open_store
from .workers import InProcess, Pool


@dataclass(frozen=True)
class LayerProfile:
    """Statistics of layers j = 0 … M − 1 (of the contacts' lower beads), both branches together.

    Forces are in units of the load's magnitude. ``ordered`` (M,): F. ``mean_change`` (M,): mean of
    g = f − F. ``mean_square`` (M,): mean of g², the variance about the ordered force, of which
    Eqs. 13 and 14 are the theory. ``mean_square_covariance`` (M, M): of these means over
    all N packings (it falls as 1/N), from the scatter over packings. ``std`` (M,): root of
    mean_square − mean_change², σ_f about the mean. ``first_order_std`` (M,): Eqs. 13 and 14
    exact at finite M, or None where they don't apply.
    """

    realisations: int
    ordered: Array
    mean_change: Array
    mean_square: Array
    mean_square_covariance: Array
    std: Array
    first_order_std: Array | None


def profile(
    scene: Scene, realisations: int, *, workers: int = 1, store: Path | None = None
) -> LayerProfile:
    """Solve an ensemble of a scene that asks for a profile; the same to the bit for any workers.

    ``workers`` above 1 are processes, which start the program anew: a script needs its
    ``if __name__ == "__main__"``. ``store`` keeps what is done, and goes on from there. Raises
    ``SceneError``, ``StoreError``, ``RealisationError``, and ``ValueError`` for fewer than two
    realisations.
    """
    if scene.ask.quantity != "profile":
        raise SceneError("ask.quantity", scene.ask.quantity, 'must be "profile" here')
    if realisations < 2:
        raise ValueError(f"realisations = {realisations}: errors need at least 2")
    m = measurement(scene, covariance=True)
    executor: Executor = InProcess() if workers == 1 else Pool(workers)
    if store is None:
        found = run(m, realisations, executor).estimates
    else:
        opened = open_store(store, ensemble_key(m))
        try:
            found = run(m, realisations, executor, store=opened).estimates
        finally:
            opened.close()

    def layers(values: list[float]) -> Array:
        return np.asarray(np.array(values).reshape(-1, 2).mean(axis=1))

    mean = layers([float(v) for v in found.mean])
    square = layers([float(v) for v in found.mean_square])
    M = len(mean)
    blocks = found.covariance().reshape(M, 2, M, 2)
    theory = m.theory()
    return LayerProfile(
        found.realisations,
        layers([float(v) for v in m.ordered()]),
        mean,
        square,
        blocks.mean(axis=(1, 3)) / found.realisations,
        np.sqrt(square - mean * mean),
        None if theory is None else np.array([float(v) for v in theory]),
    )
