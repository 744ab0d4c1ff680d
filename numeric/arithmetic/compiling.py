"""How loops are compiled: every operation rounded by itself, as NumPy rounds it.

No fast-math, and LLVM is not given leave to fuse a product with a sum, so that compiled numbers are
those of NumPy to the bit. Import it only where work repays loading the compiler (half a second).
"""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeVar, cast

import llvmlite.binding
import numba
from numba.extending import intrinsic

from .machine import cores

Function = TypeVar("Function", bound=Callable[..., Any])


def _codes() -> Path:
    """Give a folder of the user's own: what was compiled is loaded from there again."""
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "force-diffusion"
    except RuntimeError:  # nobody knows the user's home
        return Path(__file__).parent / "__pycache__"


CODES = _codes()
"""Where recorded code lies, and beside it what was compiled of it."""

# Rows never overlap, but LLVM has to check; it gives up vectorising at 8 comparisons by default.
llvmlite.binding.set_option("force-diffusion", "--runtime-memory-check-threshold=512")


def compiled(function: Function) -> Function:
    """Compile at the first call; keep the machine code on disk where a folder can be written.

    A compiled function calls only those of its own file: the copy on disk is made anew where that
    file has changed, and no other is looked at.
    """
    options: dict[str, Any] = {"error_model": "numpy", "nogil": True}
    try:
        return cast(Function, numba.njit(cache=True, **options)(function))
    except RuntimeError:  # no place to write to
        return cast(Function, numba.njit(**options)(function))


def _borrowed_code(typing: Any, array: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        given = context.make_array(signature.args[0])(context, builder, arguments[0])
        given.meminfo, given.parent = given.meminfo.type(None), given.parent.type(None)
        return given._getvalue()

    return array(array), code


borrowed: Any = intrinsic(_borrowed_code)
"""The same array without an owner, for compiled functions: nobody counts who looks at its parts.

Counting costs as much as thirty beads for each run of them. The caller must hold the array.
"""


def _fma_code(typing: Any, a: Any, b: Any, c: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fma(*arguments)

    return numba.float64(numba.float64, numba.float64, numba.float64), code


fma: Any = intrinsic(_fma_code)
"""a b + c, rounded once."""


@lru_cache(maxsize=1)
def _pool(threads: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(threads)


def on_all_cores(function: Callable[[slice], bool], batch: int) -> bool:
    """Call a compiled ``function`` for parts of a batch, one a core; say whether all are true."""
    threads = cores()
    parts = min(batch, threads)
    if parts == 1:
        return function(slice(0, batch))
    cuts = [batch * part // parts for part in range(parts + 1)]
    others = [_pool(threads).submit(function, slice(*cut)) for cut in pairwise(cuts[1:])]
    own = function(slice(0, cuts[1]))
    return all([own, *(other.result() for other in others)])
