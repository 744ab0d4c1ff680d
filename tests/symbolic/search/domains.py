"""Where the printed Eqs. 1–11 hold."""

import sympy
from force_diffusion.symbolic.kernel.where import (
    ENTERING,
    LOADED,
    LOADED_VERTICALLY,
    PASSING,
    SURFACE,
    Where,
)
from force_diffusion.symbolic.symbols import M, i, j, k, l, n, site_s

CONE = (sympy.Eq(2 * n, (l - j) - (k - i)), j >= 0)

DOMAINS = {
    1: Where.of(j >= 0, indices=(i,)),
    2: Where.of(j >= 1),
    3: Where.of(j >= 1),
    4: Where.of(j >= 0),
    5: Where.of(j >= 0),
    6: Where.of(l >= 1, loading=LOADED),
    7: Where.of(l >= 1, loading=LOADED_VERTICALLY),
    8: Where.of(site_s >= 1, loading=PASSING),
    9: Where.of(sympy.Eq(k - i, l - j), l - j >= 1, j >= 0, loading=ENTERING),
    10: Where.of(n >= 1, n < l - j, *CONE, loading=ENTERING),
    11: Where.of(j >= 0, j < M, loading=SURFACE),
}
