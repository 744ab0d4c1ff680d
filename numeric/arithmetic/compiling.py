"""How loops are compiled: every operation rounded by itself, as NumPy rounds it.

No fast-math, and LLVM is not given leave to fuse a product with a sum, so that compiled numbers are
those of NumPy to the bit. Import it only where work repays loading the compiler (half a second).
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeVar, cast

import llvmlite.binding
import numba
from numba.extending import intrinsic

from .machine import cores, user_cache

Function = TypeVar("Function", bound=Callable[..., Any])
OPTIONS: dict[str, Any] = {"error_model": "numpy", "nogil": True, "no_cfunc_wrapper": True}


CODES = user_cache() or Path(__file__).parent / "__pycache__"
"""Where recorded code lies, and beside it what was compiled of it."""

# Rows never overlap, but LLVM has to check; it gives up vectorising at 8 comparisons by default.
llvmlite.binding.set_option("force-diffusion", "--runtime-memory-check-threshold=512")


def compiled(function: Function) -> Function:
    """Compile at the first call; keep the machine code on disk where a folder can be written.

    A compiled function calls only those of its own file: the copy on disk is made anew where that
    file has changed, and no other is looked at.
    """
    try:
        return cast(Function, numba.njit(cache=True, **OPTIONS)(function))
    except RuntimeError:  # no place to write to
        return cast(Function, numba.njit(**OPTIONS)(function))


def inner(function: Function) -> Function:
    """Compile a function that compiled ones of its own file call, and nobody else.

    Kept on disk is what calls it, of which it has become a part.
    """
    return cast(Function, numba.njit(**OPTIONS | {"no_cpython_wrapper": True})(function))


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


def _scope(builder: Any, name: str) -> Any:
    """Name a class of numbers that share no memory with those of another name."""
    domain = builder.module.add_metadata(["force-diffusion"])
    return builder.module.add_metadata([name, domain])


def _address(context: Any, builder: Any, kind: Any, array: Any, index: Any) -> Any:
    return builder.gep(context.make_array(kind)(context, builder, array).data, [index])


def _taken_code(typing: Any, array: Any, index: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        number = builder.load(_address(context, builder, signature.args[0], *arguments))
        scopes = builder.module.add_metadata([_scope(builder, "taken")])
        number.set_metadata("alias.scope", scopes)
        return number

    return numba.float64(array, numba.int64), code


def _placed_code(typing: Any, array: Any, index: Any, value: Any, number: Any) -> Any:
    own, most = number.literal_value, 64

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        place = _address(context, builder, signature.args[0], *arguments[:2])
        stored = builder.store(arguments[2], place)
        names = ["taken", *(f"placed {k}" for k in range(most) if k != own)]
        others = [_scope(builder, name) for name in names]
        scopes = builder.module.add_metadata([_scope(builder, f"placed {own}")])
        stored.set_metadata("alias.scope", scopes)
        stored.set_metadata("noalias", builder.module.add_metadata(others))
        return context.get_dummy_value()

    return numba.void(array, numba.int64, numba.float64, number), code


def _pitch_code(typing: Any, array: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        given = context.make_array(signature.args[0])(context, builder, arguments[0])
        stride = builder.extract_value(given.strides, 0)
        return builder.sdiv(stride, stride.type(8))

    return numba.int64(array), code


def _alone_code(typing: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        builder.function.attributes.add("noinline")
        return context.get_dummy_value()

    return numba.void(), code


taken: Any = intrinsic(_taken_code)
"""Number ``index`` of a flat array, in a function that puts nothing there."""

placed: Any = intrinsic(prefer_literal=True)(_placed_code)
"""Put a number at ``index`` of a flat array, where nothing is taken, nor under another ``number``.

Told so, LLVM takes several beads at a time without comparing all addresses for each run of them.
"""

pitch: Any = intrinsic(_pitch_code)
"""How many numbers the rows of an array lie apart."""

alone: Any = intrinsic(_alone_code)
"""Keep a function by itself: what it takes, the next call may put."""


@lru_cache(maxsize=1)
def _pool(threads: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(threads)


def on_all_cores(function: Callable[[slice], bool], batch: int) -> bool:
    """Call a compiled ``function`` for parts of a batch, one a core; say whether all are true."""
    if batch == 1 or (threads := cores()) == 1:
        return function(slice(0, batch))
    parts = min(batch, threads)
    cuts = [batch * part // parts for part in range(parts + 1)]
    others = [_pool(threads).submit(function, slice(*cut)) for cut in pairwise(cuts[1:])]
    own = function(slice(0, cuts[1]))
    return all([own, *(other.result() for other in others)])
