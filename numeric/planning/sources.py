"""Where a scene's radii and loads come from; files are read here."""

from fractions import Fraction

from ..arithmetic.decimals import short
from ..disorder.radii import ArrayRadii, DrawnRadii, MeasuredRadii, Radii
from ..lattice.branch import Site
from ..lattice.regions import Rows
from ..mechanics.loads import LoadSpec
from ..scene.scene import Scene
from ..scene.sections import GivenRadii
from ..scene.tables import TableError, read_array, read_loads, read_radii


def load_of(scene: Scene) -> LoadSpec:
    """Give the load. Raises ``TableError``."""
    load, packing = scene.load, scene.packing
    single = {}
    if load.file is not None:
        single = read_loads(
            scene.folder / load.file,
            magnitude=load.magnitude,
            width=packing.width,
            height=packing.height,
        )
    if load.pressure and load.at is not None:  # loads on single beads, one by one
        assert packing.width is not None
        down = Fraction(load.pressure) / load.magnitude
        top = packing.height
        single = {(i, top): (Fraction(0), -down) for i in range(top % 2, 2 * packing.width, 2)}
        site = int(load.at[0]), int(load.at[1])
        single[site] = Fraction(0), single.get(site, (0, Fraction(0)))[1] - 1
        return LoadSpec("file", top, packing.width, Fraction(0), None, single)
    at = None if load.at is None else (int(load.at[0]), int(load.at[1]))
    return LoadSpec(load.kind, packing.height, packing.width, load.angle_deg, at, single)


def radii_of(scene: Scene, rows: Rows) -> Radii:
    """Give the radii of the beads of ``rows``; without rows, of all. Raises ``TableError``."""
    disorder, packing = scene.disorder, scene.packing
    assert disorder is not None
    if isinstance(disorder, GivenRadii):
        assert packing.width is not None
        values = disorder.values.reshape(-1, packing.height + 1, packing.width)
        origin = packing.radius if disorder.delta_r is None else Fraction(0)
        return ArrayRadii(values, origin, packing.radius)
    if disorder.file is None:
        assert disorder.relative_std is not None
        return DrawnRadii(disorder.kind, disorder.relative_std, disorder.seed, packing.width)

    path = scene.folder / disorder.file
    if path.suffix == ".npy":
        values = read_array(path, width=packing.width, height=packing.height)
        if abs(Fraction(float(values.mean())) - packing.radius) > packing.radius / 2:
            raise TableError(
                f"disorder.file: {path.name}: the mean radius is {values.mean():.3g}, and "
                f"packing.radius is {short(packing.radius)}: is it in another unit?"
            )
        return ArrayRadii(values[None], packing.radius, packing.radius)

    def needed(site: Site) -> bool:
        i, j = site
        if not rows:  # line sums look up what they need
            return True
        return j < len(rows) and rows[j].first <= i <= rows[j].last

    measured = read_radii(
        path,
        radius=packing.radius,
        spacing=packing.s,
        width=packing.width,
        height=packing.height,
        needed=needed,
    )
    if packing.width is None:
        missing = (
            (i, layer.j) for layer in rows for i in layer.sites() if (i, layer.j) not in measured
        )
        for site in missing:
            raise TableError(f"disorder.file: {disorder.file}: bead {site} is missing")
    return MeasuredRadii(measured, packing.width)
