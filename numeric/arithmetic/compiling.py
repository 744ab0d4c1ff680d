"""Functions as they stand, compiled by numba for this processor, and kept on disk as machine code.

What is kept is called without numba, which takes long to load: llvmlite alone puts it into memory.
Every operation is rounded by itself, as NumPy rounds it: no fast-math, and LLVM is not given leave
to fuse a product with a sum. Numbers lie behind pointers. The name of the file is made from all
sources that the code comes from, the versions of what compiled it, and the processor.
"""

# mypy: disable-error-code="untyped-decorator, name-defined, misc"

import ctypes
import hashlib
import operator
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import lru_cache, partial
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from . import carried
from .machine import user_cache, write_whole

CODES = user_cache() or Path(__file__).parent / "__pycache__"
"""Where machine code lies."""

# LLVM takes several beads at a time only where it may check that what is written is not read.
_CHECKS = ("--runtime-memory-check-threshold=2000", "--vectorize-memory-check-threshold=2000")
Function = Callable[..., Any]


def stamp(functions: Sequence[Function]) -> str:
    """Give a hash of all that the machine code of functions comes from."""
    from llvmlite import __version__, binding

    files = {function.__code__.co_filename for function in functions}
    if (numba := find_spec("numba")) is None:
        raise ModuleNotFoundError("numba")
    release = str(Path(str(numba.origin)).with_name("_version.py"))
    sources = sorted({*files, __file__, carried.__file__, release})
    texts = [Path(file).read_bytes() for file in sources]
    features = binding.get_host_cpu_features().flatten()
    made = [__version__, binding.get_host_cpu_name(), features]
    return hashlib.sha256(b"\0".join([*texts, *map(str.encode, made)])).hexdigest()[:24]


def compiled(
    entries: Sequence[tuple[Function, Sequence[str]]], called: Sequence[Function]
) -> list[Callable[..., int]] | None:
    """Give functions compiled, which return whole numbers; None where numba is not installed.

    Each of the ``entries`` is a function and the kinds of its arguments: a whole "number", a
    pointer to "whole" ones, to a "word" of 64 bits or a "float", an "offset", which is a tuple of
    one whole number, or in its place "none", an empty tuple, which is not passed. ``called`` are
    functions of Python that these call, directly or not.
    """
    try:
        from llvmlite import binding

        name = stamp([*called, *(function for function, _ in entries)])
    except ImportError:
        return None
    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    target = binding.Target.from_default_triple().create_target_machine(
        cpu=binding.get_host_cpu_name(),
        features=binding.get_host_cpu_features().flatten(),
        opt=3,
        jit=True,
    )
    path = CODES / f"{name}.o"
    try:
        code = path.read_bytes()
    except OSError:
        if sys.stderr is not None and sys.stderr.isatty():
            print("compiling for this machine, once: about 10 s", file=sys.stderr, flush=True)
        code = target.emit_object(_made(entries, called))
        with suppress(OSError):
            CODES.mkdir(parents=True, exist_ok=True)
            write_whole(path, code)
    engine = binding.create_mcjit_compiler(binding.parse_assembly(""), target)
    engine.add_object_file(binding.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return [_callable(engine, f"f{k}", kinds) for k, (_, kinds) in enumerate(entries)]


def _callable(engine: Any, name: str, kinds: Sequence[str]) -> Callable[..., int]:
    """Call machine code as C does."""
    types = [
        ctypes.c_int64 if kind in {"number", "offset"} else ctypes.c_void_p
        for kind in kinds
        if kind != "none"
    ]
    function = ctypes.CFUNCTYPE(ctypes.c_int64, *types)(engine.get_function_address(name))
    function.engine = engine  # type: ignore[attr-defined]  # it owns the code
    return function


def _made(entries: Sequence[tuple[Function, Sequence[str]]], called: Sequence[Function]) -> Any:
    """Compile functions, and give them as one module of LLVM, named f0, f1, …"""
    from llvmlite import binding

    numba: Any = import_module("numba")
    extending: Any = import_module("numba.extending")
    for option in _CHECKS:
        binding.set_option("force-diffusion", option)
    _register_carried()
    for function in called:
        extending.register_jitable(forceinline=True, error_model="numpy")(function)
    kinds = {
        "number": numba.int64,
        "offset": numba.types.UniTuple(numba.int64, 1),
        "none": numba.types.Tuple(()),
        "whole": numba.types.CPointer(numba.int64),
        "word": numba.types.CPointer(numba.uint64),
        "float": numba.types.CPointer(numba.float64),
    }
    modules = []
    for k, (function, of) in enumerate(entries):
        signature = numba.int64(*(kinds[kind] for kind in of))
        made = numba.njit(signature, error_model="numpy", no_cpython_wrapper=True)(function)
        (result,) = made.overloads.values()
        module = binding.parse_assembly(result.library.get_llvm_str())
        module.get_function(result.fndesc.llvm_cfunc_wrapper_name).name = f"f{k}"
        modules.append(module)
    for module in modules[1:]:
        modules[0].link_in(module)
    return modules[0]


@lru_cache(maxsize=1)
def _register_carried() -> None:
    """Teach numba the numbers of ``carried``, by the very functions of that module."""
    numba: Any = import_module("numba")
    cgutils: Any = import_module("numba.core.cgutils")
    of: Any = import_module("numba.extending")
    types, float64, intrinsic = numba.types, numba.float64, of.intrinsic

    class CarriedType(types.Type):
        pass

    kind = CarriedType("Carried")
    number = CarriedType, types.Float, types.Integer
    options = {"forceinline": True, "error_model": "numpy"}
    implementing = partial(of.overload, jit_options=options, strict=False)

    @of.register_model(CarriedType)
    class Model(of.models.StructModel):
        def __init__(self, manager: Any, kind: Any) -> None:
            super().__init__(manager, kind, [("value", float64), ("error", float64)])

    for name in ("value", "error"):
        of.make_attribute_wrapper(CarriedType, name, name)

    @of.type_callable(carried.Carried)
    def typer(context: Any) -> Any:
        return lambda value, error: kind

    @of.lower_builtin(carried.Carried, float64, float64)
    def construct(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        made = cgutils.create_struct_proxy(kind)(context, builder)
        made.value, made.error = arguments
        return made._getvalue()

    @intrinsic
    def fma(typing: Any, a: Any, b: Any, c: Any) -> Any:
        return float64(float64, float64, float64), lambda _, builder, __, all_: builder.fma(*all_)

    @intrinsic
    def root(typing: Any, x: Any) -> Any:
        def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            kinds = [arguments[0].type]
            return builder.call(builder.module.declare_intrinsic("llvm.sqrt", kinds), arguments)

        return float64(float64), code

    @implementing(carried.residual)
    def residual(a: Any, b: Any, product: Any) -> Any:
        return lambda a, b, product: fma(a, b, -product)

    @implementing(carried.carried)
    def as_carried(x: Any) -> Any:
        if isinstance(x, CarriedType):
            return lambda number: number
        return lambda number: carried.Carried(float(number), 0.0)

    @implementing(carried.sqrt)
    def sqrt(x: Any) -> Any:
        if not isinstance(x, CarriedType):
            return lambda x: root(x)  # noqa: PLW0108 - numba takes functions of Python

        def with_error(x: Any) -> Any:
            value = root(x.value)
            off = x.error - fma(value, value, -x.value)
            return carried.Carried(value, off / (value + value))

        return with_error

    @implementing(operator.neg)
    def negative(x: Any) -> Any:
        if isinstance(x, CarriedType):
            return lambda x: carried.Carried(-x.value, -x.error)
        return None

    def register(operation: Any, function: Function) -> None:
        of.register_jitable(**options)(function)
        as_one = carried.carried

        @implementing(operation)
        def operated(x: Any, y: Any) -> Any:
            both = isinstance(x, number) and isinstance(y, number)
            if not both or CarriedType not in (type(x), type(y)):
                return None
            return lambda x, y: function(as_one(x), as_one(y))

    register(operator.add, carried.added)
    register(operator.sub, carried.subtracted)
    register(operator.mul, carried.multiplied)
    register(operator.truediv, carried.divided)
