"""Where a scene's radii and loads come from, files among them; whether float64 holds them."""

from fractions import Fraction

from ..disorder.radii import ArrayRadii, DrawnRadii, MeasuredRadii, Radii
from ..lattice.branch import Site
from ..lattice.layers import Naming, Rows
from ..mechanics.loads import LoadSpec
from ..scene.files import TableError, read_array, read_loads, read_radii
from ..scene.scene import CheckedScene
from ..scene.sections import GivenRadii

# Units of length of an array by which r may differ from 1.
FARTHEST_UNIT, CLOSEST_UNIT = Fraction(10**100), Fraction(1, 10**100)
# δr/r may be as small as this; where it meets a load or a unit of length, their product a bit less.
LEAST, LEAST_PRODUCT = Fraction(1, 10**300), Fraction(1, 10**305)
# Sums over a packing (i up to 2^60) must stay below 1e308.
MOST = Fraction(10**280)


def load_of(scene: CheckedScene) -> LoadSpec:
    """Give the load. Raises ``TableError``."""
    load, packing = scene.load, scene.packing
    naming, d = Naming(packing.dimension, packing.width), packing.dimension
    at = None if load.at is None else naming.site(load.at)
    single: dict[Site, tuple[Fraction, ...]] = {}
    if load.file is not None:
        single = read_loads(scene.folder / load.file, packing, load.magnitude)
    return LoadSpec(load.kind, packing.height, naming.row, load.angle_deg, at, single, d)


def radii_of(scene: CheckedScene, rows: Rows) -> Radii:
    """Give the radii of the beads of ``rows``; without rows, of all. Raises ``TableError``."""
    disorder, packing, r = scene.disorder, scene.packing, scene.packing.radius
    assert disorder is not None
    width = Naming(packing.dimension, packing.width).row
    if isinstance(disorder, GivenRadii):
        values = disorder.values.reshape(-1, packing.height + 1, width or 0)
        return ArrayRadii(values, r if disorder.delta_r is None else Fraction(0), r)
    if disorder.file is None:
        assert disorder.relative_std is not None
        return DrawnRadii(disorder.kind, disorder.relative_std, disorder.seed, width)
    path = scene.folder / disorder.file
    if path.suffix == ".npy":
        return ArrayRadii(read_array(path, packing).reshape(1, packing.height + 1, -1), r, r)

    def needed(site: Site) -> bool:
        i, j = site  # line sums, which have no rows, look up what they need
        return not rows or (j < len(rows) and i in rows[j].sites())

    measured = read_radii(path, packing, needed)
    if packing.width is None:
        for site in ((i, layer.j) for layer in rows for i in layer.sites()):
            if site not in measured:
                raise TableError(f"disorder.file: {disorder.file}: bead {site} is missing")
    return MeasuredRadii(measured, width)


def beyond_floats(scene: CheckedScene, radii: Radii, load: LoadSpec) -> bool:
    """Say whether float64 would overflow, or round a change that is asked for to zero.

    A change is about δr/r times the load, or times the unit of length. Errors of given radii are
    products of these.
    """
    packing, spread = scene.packing, radii.relative_std
    if isinstance(radii, MeasuredRadii):
        spread = min((abs(v) for v in radii.rho.values() if v), default=Fraction(0))
    if isinstance(radii, ArrayRadii) and not CLOSEST_UNIT <= packing.radius <= FARTHEST_UNIT:
        return True
    units = [packing.radius if "positions" in scene.ask.quantities else Fraction(1)]
    if scene.ask.quantities != ("positions",):
        units += [scene.load.magnitude]
        sizes = (max(map(abs, force)) for force in load.single.values())
        units += [size * unit for size in sizes if size for unit in (1, scene.load.magnitude)]
    least = LEAST_PRODUCT / (spread or 1)
    return 0 < spread < LEAST or not all(least <= unit <= MOST for unit in units)
