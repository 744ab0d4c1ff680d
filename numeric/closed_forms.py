"""Closed forms: variances (13–14, 16 as printed, B2–3, B13–14) and means (B5–6).

All functions give a variance over a squared force, or a mean over its ordered value: numbers
without unit. Their formulas are those of ``generated``, plain arithmetic with no constant but whole
numbers, which is made by ``python -m force_diffusion.derivations.export.generate_closed_forms``.
Arguments are scalars. The result is of the type of ``phi``, ``sigma`` and ``r``: float, a NumPy
scalar, Fraction, mpmath.mpf, arb and the like. ``M`` and the indices become Python's int, which
never overflows. With ``sigma = r = 1`` the result is the factor of (σ_δr/r)², which neither
overflows nor underflows.

Arguments:
    M: height of the packing in layers, a whole number ≥ 1 (3.0 is one).
    j: layer of the contact's lower bead, a whole number, 0 ≤ j < M.
    z: height of the contact over that of the packing, j/M, from 0 to 1; as an asymptotic form it
        holds for 0 < z < 1.
    t: L⁻/L⁺ of the load −(L⁺n⁺ + L⁻n⁻) for f⁺; L⁺/L⁻ for f⁻. 1 for a vertical load.
    l: layer of the loaded bead, a whole number ≥ 0.
    phi: n⁺·n⁻, without unit; −1/2 < φ < 1/2 in a packing without overlaps (not checked). Of spheres
        the mutual dot product of the base vectors; −1/3 < φ < 1/2.
    sigma: standard deviation σ_δr of the radii, a length.
    r: mean radius, in the same unit; not 0.

All raise ``ValueError`` where a whole number, z or a branch is not allowed, or is an array.
"""

from collections.abc import Callable
from numbers import Integral
from typing import Any

from . import generated


def _whole(name: str, value: Any, least: int) -> int:
    try:
        whole = None if hasattr(value, "__len__") else int(value)
    except (TypeError, ValueError, OverflowError):
        whole = None
    if whole is None or whole != value or whole < least:
        raise ValueError(f"{name} = {value!r}: one whole number from {least} up is allowed")
    return whole


def _fraction(z: Any) -> Any:
    if hasattr(z, "__len__") or not 0 <= z <= 1:
        raise ValueError(f"z = {z!r}: one number from 0 to 1 is allowed")
    return _endless(z)


def _endless(value: Any) -> Any:
    """The same value, as Python's int where it is of a whole type, which might overflow."""
    return int(value) if isinstance(value, Integral) else value


def _leading(form: Callable[..., Any], M: Any, z: Any, phi: Any, sigma: Any, r: Any) -> Any:
    return form(_whole("M", M, 1), _fraction(z), _endless(phi)) * (sigma / r) ** 2


def _of_contact(
    form: Callable[..., Any], M: Any, j: Any, phi: Any, sigma: Any, r: Any, *t: Any
) -> Any:
    M, j = _whole("M", M, 1), _whole("j", j, 0)
    if j >= M:
        raise ValueError(f"no contact starts in layer j = {j}: 0 <= j < M = {M} is allowed")
    return form(M, j, M - j, *t, _endless(phi)) * (sigma / r) ** 2


def surface_diffusion(M: Any, z: Any, phi: Any, sigma: Any, r: Any) -> Any:
    """Printed leading order of σ_f²/⟨f⟩² for M → ∞ at fixed z, surface load (Eq. 13)."""
    return _leading(generated.surface_diffusion, M, z, phi, sigma, r)


def bulk_diffusion(M: Any, z: Any, phi: Any, sigma: Any, r: Any) -> Any:
    """Printed leading order of σ_f²/⟨f⟩² for M → ∞ at fixed z, bulk load (Eq. 14)."""
    return _leading(generated.bulk_diffusion, M, z, phi, sigma, r)


def surface_variance(M: Any, j: Any, phi: Any, sigma: Any, r: Any) -> Any:
    """Exact σ_f²/⟨f⟩² of f^±_ij to first order in δr at finite M, surface load (Eq. 13)."""
    return surface_variance_at_angle(M, j, 1, phi, sigma, r)


def bulk_variance(M: Any, j: Any, phi: Any, sigma: Any, r: Any) -> Any:
    """Exact σ_f²/⟨f⟩² of f^±_ij to first order in δr at finite M, bulk load (Eq. 14)."""
    return bulk_variance_at_angle(M, j, 1, phi, sigma, r)


def surface_variance_at_angle(M: Any, j: Any, t: Any, phi: Any, sigma: Any, r: Any) -> Any:
    """Exact σ_f²/⟨f⟩² of f^±_ij to first order at finite M, surface load at an angle (Eq. B2)."""
    return _of_contact(generated.surface_variance_at_angle, M, j, phi, sigma, r, t)


def bulk_variance_at_angle(M: Any, j: Any, t: Any, phi: Any, sigma: Any, r: Any) -> Any:
    """Exact σ_f²/⟨f⟩² of f^±_ij to first order at finite M, bulk load at an angle (Eq. B3)."""
    return _of_contact(generated.bulk_variance_at_angle, M, j, phi, sigma, r, t)


def surface_variance_of_spheres(M: Any, j: Any, phi: Any, sigma: Any, r: Any) -> Any:
    """Exact σ_f²/⟨f⟩² of spheres to first order in δr at finite M, surface load (Eq. B13)."""
    return _of_contact(generated.surface_variance_of_spheres, M, j, phi, sigma, r)


def bulk_variance_of_spheres(M: Any, j: Any, phi: Any, sigma: Any, r: Any) -> Any:
    """Exact σ_f²/⟨f⟩² of spheres to first order in δr at finite M, bulk load (Eq. B14)."""
    return _of_contact(generated.bulk_variance_of_spheres, M, j, phi, sigma, r)


def surface_mean_shift(M: Any, j: Any, phi: Any, sigma: Any, r: Any) -> Any:
    """Exact ⟨f^±_ij⟩ over its ordered value, minus 1, at order σ², surface load (Eq. B5)."""
    return _of_contact(generated.surface_mean_shift, M, j, phi, sigma, r)


def bulk_mean_shift(M: Any, j: Any, phi: Any, sigma: Any, r: Any) -> Any:
    """Exact ⟨f^±_ij⟩ over its ordered value, minus 1, at order σ², bulk load (Eq. B6)."""
    return _of_contact(generated.bulk_mean_shift, M, j, phi, sigma, r)


def surface_diffusion_of_spheres(M: Any, z: Any, phi: Any, sigma: Any, r: Any) -> Any:
    """Leading order of σ_f²/⟨f⟩² of spheres for M → ∞ at fixed z, surface load (Eq. B13)."""
    return _leading(generated.surface_diffusion_of_spheres, M, z, phi, sigma, r)


def bulk_diffusion_of_spheres(M: Any, z: Any, phi: Any, sigma: Any, r: Any) -> Any:
    """Leading order of σ_f²/⟨f⟩² of spheres for M → ∞ at fixed z, bulk load (Eq. B14)."""
    return _leading(generated.bulk_diffusion_of_spheres, M, z, phi, sigma, r)


def response(l: Any, j: Any, phi: Any, sigma: Any, r: Any) -> Any:
    """Printed leading order of σ²(p)/f_load² inside the cone of a load on layer l (Eq. 16).

    p is the vertical force that both of its upper contacts exert on a bead of layer j ≥ 0. As an
    asymptotic form it holds for l → ∞ at fixed j/l.
    """
    l, j, phi = _whole("l", l, 0), _whole("j", j, 0), _endless(phi)
    return generated.response(j, l, phi) * (sigma / r) ** 2
