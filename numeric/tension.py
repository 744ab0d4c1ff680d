"""Expected fraction of tensile contacts (Eq. 15): an estimate to first order in δr.

To first order a contact force is a linear form in the radii. For normal radii it is Gaussian, for
others it becomes so as M → ∞ (central limit theorem); with σ_f²/⟨f⟩² of its layer it is then
negative with the probability ½ erfc(⟨f⟩/√2 σ_f). Where a finite fraction is tensile, M ≈ M*,
first order is no longer small: only a simulation can tell by how much the estimate is off.
"""

from typing import Any

import mpmath

from numeric import closed_forms

LOADS = ("surface", "bulk")

_VARIANCES = {"surface": closed_forms.surface_variance, "bulk": closed_forms.bulk_variance}
_PEAKS = {"surface": 0, "bulk": 1 / 6}  # about where σ_f²/⟨f⟩² is largest: a place to split at


def critical_height(phi: Any, sigma: Any, r: Any, load: str, digits: int = 15) -> mpmath.mpf:
    """M* = ((1−φ²) r/σ)^(2/3) for a surface load, 5^(1/3) times that for a bulk load (Eq. 15).

    Here the leading order of the mean of σ_f²/⟨f⟩² over all contacts is one.

    Args:
        phi: n⁺·n⁻, without unit, −1/2 < φ < 1/2.
        sigma: standard deviation σ_δr of the radii, a length > 0.
        r: mean radius, in the same unit, > 0.
        load: "surface" or "bulk".
        digits: decimal digits of the result, 1 or more.

    Raises:
        ValueError: an argument is not allowed.
    """
    with mpmath.workdps(_checked(load, digits)):
        cosine, deviation, radius = _parameters(phi, sigma, r)
        if deviation == 0:
            raise ValueError("sigma = 0: equal radii have no tensile contact at any height")
        cubed = ((1 - cosine) * (1 + cosine) * radius / deviation) ** 2
        height = mpmath.cbrt(cubed * (5 if load == "bulk" else 1))
    return _rounded(height, digits)


def tensile_fraction(
    M: Any, phi: Any, sigma: Any, r: Any, load: str, digits: int = 15
) -> mpmath.mpf:
    """Mean over the layers 0 ≤ j < M of ½ erfc(⟨f⟩/√2 σ_f), with the exact first-order σ_f.

    Args:
        M: height of the packing in layers, a whole number ≥ 1; the time is proportional to it.
        phi: n⁺·n⁻, without unit, −1/2 < φ < 1/2.
        sigma: standard deviation σ_δr of the radii, a length ≥ 0.
        r: mean radius, in the same unit, > 0.
        load: "surface" or "bulk".
        digits: decimal digits of the result, 1 or more.

    Raises:
        ValueError: an argument is not allowed.
    """
    with mpmath.workdps(_checked(load, digits)):
        cosine, deviation, radius = _parameters(phi, sigma, r)
        variance = _VARIANCES[load]
        variance(M, 0, cosine, deviation, radius)  # refuses what is no height
        layers = range(int(M))
        total = mpmath.fsum(_tail(variance(M, j, cosine, deviation, radius)) for j in layers)
        fraction = total / int(M)
    return _rounded(fraction, digits)


def limiting_fraction(ratio: Any, load: str, digits: int = 15) -> mpmath.mpf:
    """The same as M → ∞ at a fixed ``ratio`` M/M* ≥ 0: it depends on nothing else (Eq. 15).

    The integral over z is of a smooth function, by tanh-sinh quadrature.

    Raises:
        ValueError: an argument is not allowed.
    """
    with mpmath.workdps(_checked(load, digits)):
        scale = _number("ratio", ratio)
        if scale < 0:
            raise ValueError(f"ratio = {ratio!r}: a number M/M* from 0 on is allowed")
        top, steepness = (2, 2) if load == "surface" else (mpmath.mpf(3) / 2, 4)

        def integrand(z: mpmath.mpf) -> mpmath.mpf:
            return _tail(scale**3 * top * (1 - z) ** 2 * (1 + steepness * z))

        peak = _PEAKS[load]
        # the integrand falls off over a distance of order (M/M*)^(3/2) from the peak
        width = min(scale ** mpmath.mpf(1.5), mpmath.mpf(1) / 8)
        marks = {0, 1, peak, *(peak + side * n * width for side in (-1, 1) for n in (2, 5))}
        value = mpmath.quad(integrand, sorted(mark for mark in marks if 0 <= mark <= 1))
    return _rounded(value, digits)


def _tail(variance: mpmath.mpf) -> mpmath.mpf:
    """Probability that a Gaussian of mean one is negative."""
    return mpmath.erfc(1 / mpmath.sqrt(2 * variance)) / 2 if variance else mpmath.mpf(0)


def _checked(load: str, digits: int) -> int:
    """Working digits: a few more than asked for."""
    if load not in LOADS:
        raise ValueError(f"load = {load!r}: 'surface' or 'bulk' is allowed")
    if isinstance(digits, bool) or not isinstance(digits, int) or digits < 1:
        raise ValueError(f"digits = {digits!r}: a whole number from 1 on is allowed")
    return digits + 10


def _number(name: str, value: Any) -> mpmath.mpf:
    try:
        number = mpmath.mpmathify(value)
    except (TypeError, ValueError):
        number = None
    if not isinstance(number, mpmath.mpf) or not mpmath.isfinite(number):
        raise ValueError(f"{name} = {value!r}: one finite number is allowed")
    return number


def _parameters(phi: Any, sigma: Any, r: Any) -> tuple[mpmath.mpf, mpmath.mpf, mpmath.mpf]:
    cosine, deviation, radius = _number("phi", phi), _number("sigma", sigma), _number("r", r)
    if abs(cosine) >= mpmath.mpf(1) / 2:
        raise ValueError(f"phi = {phi!r}: -1/2 < phi < 1/2 is allowed")
    if deviation < 0:
        raise ValueError(f"sigma = {sigma!r}: a length from 0 on is allowed")
    if radius <= 0:
        raise ValueError(f"r = {r!r}: a length above 0 is allowed")
    return cosine, deviation, radius


def _rounded(value: mpmath.mpf, digits: int) -> mpmath.mpf:
    with mpmath.workdps(digits):
        return +value
