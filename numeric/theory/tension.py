"""Expected fraction of tensile contacts (Eq. 15): an estimate to first order in δr.

To first order a contact force is a linear form in the radii. For normal radii it is Gaussian, for
others it becomes so as M → ∞ (central limit theorem); with σ_f²/⟨f⟩² of its layer it is then
negative with the probability ½ erfc(⟨f⟩/√2 σ_f). Near M* a force changes by as much as its mean;
how well a linear form still gives the fraction is measured, not bounded: exact packings at M ≈ M*
had 1 % more tensile contacts than first order at σ/r = 0.01, and as many, to 0.01 %, at 0.001.
"""

from typing import Any

import mpmath

from .. import closed_forms

LOADS = ("surface", "bulk")

_VARIANCES = {"surface": closed_forms.surface_variance, "bulk": closed_forms.bulk_variance}
_PROFILES = {"surface": (0, 2, 2), "bulk": (mpmath.rational.mpq(1, 6), 1.5, 4)}
"""z of the peak, a and c of σ_f²/⟨f⟩² = a (M/M*)³ (1−z)² (1+cz) at leading order."""


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
    working = _checked(load, digits)
    with mpmath.workdps(working):
        cosine, deviation, radius = _parameters(phi, sigma, r)
        spread = (deviation / radius) ** 2  # σ_f²/⟨f⟩² is no less than about half of this
    with mpmath.workdps(working + _lost(spread)):
        cosine, deviation, radius = _parameters(phi, sigma, r)
        variance = _VARIANCES[load]
        variance(M, 0, cosine, deviation, radius)  # refuses what is no height
        layers = range(int(M))
        total = mpmath.fsum(_tail(variance(M, j, cosine, deviation, radius)) for j in layers)
        fraction = total / int(M)
    return _rounded(fraction, digits)


def limiting_fraction(ratio: Any, load: str, digits: int = 15) -> mpmath.mpf:
    """The same as M → ∞ at a fixed ``ratio`` M/M* ≥ 0: it depends on nothing else (Eq. 15).

    The integrand, smooth and with a single peak, is taken over its height there and integrated in
    units of its width, by tanh-sinh quadrature on intervals that double away from the peak.

    Raises:
        ValueError: an argument is not allowed.
    """
    working = _checked(load, digits)
    with mpmath.workdps(working):
        cubed = _number("ratio", ratio) ** 3
        if cubed < 0:
            raise ValueError(f"ratio = {ratio!r}: a number M/M* from 0 on is allowed")
        if cubed == 0:
            return mpmath.mpf(0)
    with mpmath.workdps(working + _lost(cubed)):
        cubed = _number("ratio", ratio) ** 3
        peak, top, steepness = (mpmath.mpmathify(number) for number in _PROFILES[load])
        width = min(mpmath.sqrt(cubed), mpmath.mpf(1) / 8)

        def tail(z: mpmath.mpf) -> mpmath.mpf:
            return _tail(cubed * top * (1 - z) ** 2 * (1 + steepness * z))

        highest = tail(peak)
        # what is left out beyond a mark where the integrand has fallen to this is below it
        negligible = width * mpmath.mpf(10) ** -working
        marks = [mpmath.mpf(0)]
        for end in (-peak / width, (1 - peak) / width):
            step = mpmath.sign(end)
            while abs(step) < abs(end) and tail(peak + step * width) > negligible * highest:
                marks.append(step)
                step *= 2
            marks.append(step if abs(step) < abs(end) else end)
        value = (
            highest
            * width
            * mpmath.quad(lambda u: tail(peak + u * width) / highest, sorted(set(marks)))
        )
    return _rounded(value, digits)


def _lost(variance: mpmath.mpf) -> int:
    """Digits that a tail loses to the size of its exponent, 1/2σ_f²."""
    return max(0, -int(mpmath.floor(mpmath.log10(variance)))) if variance else 0


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
