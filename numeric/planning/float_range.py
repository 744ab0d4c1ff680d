"""What float64 can hold: scenes beyond it are refused, unless a tolerance asks for balls.

A change is about δr/r times the load. Below 1e-308 hardware floats round it to zero without a
word, which would then pass for an answer without error.
"""

from fractions import Fraction

from ..arithmetic.decimals import short
from ..disorder.radii import ArrayRadii, MeasuredRadii, Radii
from ..lattice.naming import Naming
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
    disorder, given = radii.relative_std(), scene.disorder
    key, what = "relative_std", ""
    value: Fraction | str | None = disorder
    if isinstance(radii, MeasuredRadii):
        assert given is not None
        disorder = radii.least
        key, value = "file", given.file
        what = f"a delta_r/r of {short(disorder)}; "
    elif isinstance(radii, ArrayRadii):
        key = given.name if isinstance(given, GivenRadii) else "file"
    if disorder and disorder < LEAST:
        why = f"{what}in float64 it must be zero or at least 1e-300: {WAY_OUT}"
        raise SceneError(f"disorder.{key}", value, why)
    least = LEAST_PRODUCT / (disorder or 1)
    allowed = (
        f"must lie between {short(least)} and {short(MOST)} in float64 where delta_r/r is "
        f"{short(disorder)}: choose another unit, or {WAY_OUT}"
    )
    key, unit = "load.magnitude", scene.load.magnitude
    if scene.ask.quantity == "positions":
        key, unit = "packing.radius", scene.packing.radius
    if not least <= unit <= MOST:
        raise SceneError(key, unit, allowed)
    for site, force in load.single.items() if key == "load.magnitude" else ():
        size = max(map(abs, force))
        if size and not (least <= size <= MOST and least <= size * unit <= MOST):
            bead = Naming(load.dimension, scene.packing.width).bead(site)
            raise SceneError(
                "load.file" if scene.load.file else "load.pressure",
                scene.load.file or scene.load.pressure,
                f"the load on bead {bead} is {short(size)} times load.magnitude, which {allowed}",
            )
