"""Where a scene's radii and loads come from; files are read here."""

from fractions import Fraction

import numpy as np

from ..arithmetic.decimals import short
from ..arithmetic.systems import Array
from ..disorder.radii import ArrayRadii, DrawnRadii, MeasuredRadii, Radii
from ..lattice.branch import Site
from ..lattice.layers import Rows, full_layer, site_of
from ..mechanics.loads import LoadSpec
from ..scene.scene import Scene
from ..scene.sections import GivenRadii
from ..scene.tables import TableError, read_array, read_loads, read_radii

# Powers of two by which a unit of length may differ from r.
FARTHEST_UNIT = 100


def load_of(scene: Scene) -> LoadSpec:
    """Give the load. Raises ``TableError``."""
    load, packing = scene.load, scene.packing
    single: dict[Site, tuple[Fraction, ...]] = {}
    if load.file is not None:
        single = read_loads(
            scene.folder / load.file,
            magnitude=load.magnitude,
            width=packing.width,
            height=packing.height,
            dimension=packing.dimension,
        )
    if packing.dimension == 3:
        return _load_of_spheres(scene, single)
    if load.pressure and load.at is not None:  # loads on single beads, one by one
        assert packing.width is not None
        down = Fraction(load.pressure) / load.magnitude
        top = packing.height
        single = {(i, top): (Fraction(0), -down) for i in range(top % 2, 2 * packing.width, 2)}
        site = int(load.at[0]), int(load.at[1])
        single[site] = Fraction(0), single.get(site, (Fraction(0),))[-1] - 1
        return LoadSpec("file", top, packing.width, Fraction(0), None, single)
    at = None if load.at is None else (int(load.at[0]), int(load.at[1]))
    return LoadSpec(load.kind, packing.height, packing.width, load.angle_deg, at, single)


def _load_of_spheres(scene: Scene, single: dict[Site, tuple[Fraction, ...]]) -> LoadSpec:
    """Give the load in three dimensions, beads as sites in rows of W²."""
    load, width, top = scene.load, scene.packing.width, scene.packing.height
    assert width is not None
    if load.at is None:
        return LoadSpec(load.kind, top, width**2, load.angle_deg, single=single, dimension=3)
    p, q, j = map(int, load.at)
    at = site_of((p, q, j), width)
    if not load.pressure:
        return LoadSpec(load.kind, top, width**2, load.angle_deg, at, dimension=3)
    down = -Fraction(load.pressure) / load.magnitude
    none = Fraction(0)
    single = {(i, top): (none, none, down) for i in full_layer(top, width**2).sites()}
    single[at] = none, none, single.get(at, (none,))[-1] - 1
    return LoadSpec("file", top, width**2, single=single, dimension=3)


def _of_array(values: Array, origin: Fraction, radius: Fraction) -> ArrayRadii:
    """Take an array in units of length near r, where it is far from 1.

    The errors that float64 carries of δr/r would underflow beside a radius of 1e-300. A power of
    two changes no digit.
    """
    power = radius.denominator.bit_length() - radius.numerator.bit_length()
    if abs(power) > FARTHEST_UNIT:
        with np.errstate(all="ignore"):
            scaled = np.ldexp(values, power)
            exact = np.array_equal(np.ldexp(scaled, -power), values)
        if exact:
            unit = Fraction(2) ** power
            return ArrayRadii(scaled, origin * unit, radius * unit)
    return ArrayRadii(values, origin, radius)


def radii_of(scene: Scene, rows: Rows) -> Radii:
    """Give the radii of the beads of ``rows``; without rows, of all. Raises ``TableError``."""
    disorder, packing = scene.disorder, scene.packing
    assert disorder is not None
    if isinstance(disorder, GivenRadii):
        assert packing.width is not None
        beads = packing.width ** (packing.dimension - 1)
        values = disorder.values.reshape(-1, packing.height + 1, beads)
        origin = packing.radius if disorder.delta_r is None else Fraction(0)
        return _of_array(values, origin, packing.radius)
    if disorder.file is None:
        assert disorder.relative_std is not None
        width = packing.width
        if width is not None and packing.dimension == 3:
            width *= width
        return DrawnRadii(disorder.kind, disorder.relative_std, disorder.seed, width)

    path = scene.folder / disorder.file
    if path.suffix == ".npy":
        values = read_array(path, packing.shape)
        if abs(Fraction(float(values.mean())) - packing.radius) > packing.radius / 2:
            raise TableError(
                f"disorder.file: {path.name}: the mean radius is {values.mean():.3g}, and "
                f"packing.radius is {short(packing.radius)}: is it in another unit?"
            )
        values = values.reshape(1, packing.height + 1, -1)
        return _of_array(values, packing.radius, packing.radius)

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
        dimension=packing.dimension,
    )
    if packing.width is None:
        missing = (
            (i, layer.j) for layer in rows for i in layer.sites() if (i, layer.j) not in measured
        )
        for site in missing:
            raise TableError(f"disorder.file: {disorder.file}: bead {site} is missing")
    width = packing.width
    return MeasuredRadii(measured, None if width is None else width ** (packing.dimension - 1))
