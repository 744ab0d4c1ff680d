"""The q-model: each bead passes its load on to two beads below, in random shares q and 1 − q.

S. N. Coppersmith, C.-h. Liu, S. Majumdar, O. Narayan and T. A. Witten, Phys. Rev. E 53, 4673
(1996), with q uniform on [0, 1], two supports, weightless beads and the same load on every bead of
the surface. (We take this to be the paper's reference ``q_model``, and ``jaco_1`` or ``jaco_2`` to
be J. H. Snoeijer and J. M. J. van Leeuwen, "Force correlations in the q-model for general
q-distributions", arXiv:cond-mat/0202120; the paper's source has no bibliography.)

Let c_n(D) = ⟨w_i w_(i+n)⟩ − 1 at depth D, mean load 1. Shares of different beads are independent,
with ⟨q²⟩ = 1/3 and ⟨q(1 − q)⟩ = 1/6, so that exactly

    c_n(D + 1) = (c_(n−1) + 2 c_n + c_(n+1))/4 + s_n (1 + c_0),   s_0 = 1/6, s_(±1) = −1/12,

and c = 0 at the surface. The sources sum to zero, since beads only share what they carry; that is
why the variance saturates. The paper's "Brownian expectation σ² ~ 1 − z, as seen in e.g. the
q-model" is not what the load on a bead does here: Brownian is the spread of a point load.
"""

import numpy as np

from ..arithmetic.systems import Array


def weight_variance(depth: int) -> Array:
    """Give the variance of the load on a bead at depths 0 … ``depth``, mean load 1; exact.

    It is 1/6 one layer below the surface and tends to 1/2, its deviation from there falling as
    depth^(-1/2): in this model the load on a bead does not broaden in proportion to depth.

    >>> [float(round(v, 6)) for v in weight_variance(2)]
    [0.0, 0.166667, 0.236111]
    """
    c = np.zeros(depth + 2)  # c_n for n ≥ 0; beyond depth D it is zero
    variances = [0.0]
    for _ in range(depth):
        left, right = np.append(c[1], c[:-1]), np.append(c[1:], 0.0)
        source = 1 + c[0]
        c = (left + 2 * c + right) / 4
        c[0] += source / 6
        c[1] -= source / 12
        variances.append(float(c[0]))
    return np.array(variances)
