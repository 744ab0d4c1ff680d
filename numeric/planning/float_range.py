"""What float64 can hold: scenes beyond it are refused, unless a tolerance asks for balls.

A change is about δr/r times the load. Below 1e-308 hardware floats round it to zero without a
word, which would then pass for an answer without error.
"""

from fractions import Fraction

from ..arithmetic.decimals import short
from ..disorder.radii import ArrayRadii, MeasuredRadii, Radii
from ..lattice.branch import Site
from ..lattice.layers import bead_of
from ..mechanics.loads import LoadSpec
from ..scene.scene import Scene
from ..scene.sections import GivenRadii, SceneError

# δr/r may be as small as this; where it meets a load or a unit of length, their product a bit less.
LEAST, LEAST_PRODUCT = Fraction(1, 10**300), Fraction(1, 10**305)
# Sums over a packing (i up to 2^60) must stay below 1e308.
MOST = Fraction(10**280)
WAY_OUT = "give a tolerance: balls, its arithmetic, have no such limit"


def check(scene: Scene, radii: Radii, load: LoadSpec) -> None:
    """Raise ``SceneError`` where float64 would overflow, or round what is asked for to zero."""
    disorder = radii.relative_std()
    if isinstance(radii, MeasuredRadii):
        assert scene.disorder is not None
        disorder = radii.least
        if disorder and disorder < LEAST:
            raise SceneError(
                "disorder.file",
                scene.disorder.file,
                f"a delta_r/r of {short(disorder)}; in float64 it must be zero or at least 1e-300: "
                f"{WAY_OUT}",
            )
    elif disorder and disorder < LEAST:
        given = "file" if isinstance(radii, ArrayRadii) else "relative_std"
        given = scene.disorder.name if isinstance(scene.disorder, GivenRadii) else given
        raise SceneError(
            f"disorder.{given}",
            disorder,
            f"in float64 it must be zero or at least 1e-300: {WAY_OUT}",
        )
    least = LEAST_PRODUCT / (disorder or 1)

    def allowed() -> str:
        return (
            f"must lie between {short(least)} and {short(MOST)} in float64 where delta_r/r is "
            f"{short(disorder)}: choose another unit, or {WAY_OUT}"
        )

    r = scene.packing.radius
    if scene.ask.quantity == "positions":
        if not least <= r <= MOST:
            raise SceneError("packing.radius", r, allowed())
        return
    unit = scene.load.magnitude
    if not least <= unit <= MOST:
        raise SceneError("load.magnitude", unit, allowed())
    for site, force in load.single.items():
        size = max(map(abs, force))
        if size and not (least <= size <= MOST and least <= size * unit <= MOST):
            raise SceneError(
                "load.file" if scene.load.file else "load.pressure",
                scene.load.file or scene.load.pressure,
                f"the load on bead {_named(site, scene)} is {short(size)} times load.magnitude, "
                f"which {allowed()}",
            )


def _named(site: Site, scene: Scene) -> tuple[int, ...]:
    if scene.packing.dimension == 2:
        return site
    return bead_of(site, scene.packing.width or 1)
