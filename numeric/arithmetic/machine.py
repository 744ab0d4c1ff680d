"""Cores and free memory of this machine, and files written completely or not at all."""

import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

# Of a control group, version 1 and 2: where it is, its limit and its use.
_GROUPS = {
    "memory": ("memory", "memory.limit_in_bytes", "memory.usage_in_bytes"),
    "": ("", "memory.max", "memory.current"),
}
_CACHE = {"inactive_file", "active_file"}  # the kernel makes room of it


def user_cache() -> Path | None:
    """Give the user's folder for what was compiled; None where nobody knows the user's home."""
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "force-diffusion"
    except RuntimeError:
        return None


def write_whole(path: Path, content: bytes) -> None:
    """Write a file, all of it or nothing: beside its place first, and renamed.

    What is no file, such as a pipe, is written as it stands. Raises ``OSError``.
    """
    place = path.resolve()
    if place.exists() and not place.is_file():
        place.write_bytes(content)
        return
    beside = place.with_name(f".{place.name}.{os.urandom(4).hex()}")
    try:
        with beside.open("xb") as file:
            file.write(content)
        beside.replace(place)
    finally:
        beside.unlink(missing_ok=True)


def cores() -> int:
    """Give the number of cores that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not on this system
        return os.cpu_count() or 1


def memory_limit() -> int:
    """Give the bytes that may be used: most of what is free, 1 GB where that is unknown.

    Free is what no program uses, files that the system keeps included; a container, a batch system
    (control groups) and ``ulimit -v`` may allow less.
    """
    free = [*_free_of_machine(), *free_of_groups(), *_free_of_process()]
    return max(int(0.8 * min(free)), 0) if free else 10**9


def _free_of_machine() -> Iterator[int]:
    with suppress(OSError):
        for line in Path("/proc/meminfo").read_text().splitlines():
            if line.startswith("MemAvailable:"):
                yield 1024 * int(line.split()[1])


def free_of_groups(
    own: Path = Path("/proc/self/cgroup"), root: Path = Path("/sys/fs/cgroup")
) -> Iterator[int]:
    """Give the free bytes of every limited control group that this process is in."""
    with suppress(OSError):
        for line in own.read_text().splitlines():
            _, controllers, name = line.split(":", 2)
            if controllers not in _GROUPS:
                continue
            folder, limit, used = _GROUPS[controllers]
            top = root / folder
            group = top / name.lstrip("/")  # as seen from outside: in a container it is not there
            for path in {top, group, *(p for p in group.parents if top in p.parents)}:
                with suppress(OSError, ValueError):  # no such file, or "max"
                    allowed = int((path / limit).read_text())
                    counts = map(str.split, (path / "memory.stat").read_text().splitlines())
                    cache = sum(int(size) for key, size in counts if key in _CACHE)
                    yield allowed - int((path / used).read_text()) + cache


def _free_of_process() -> Iterator[int]:
    with suppress(ImportError, OSError):
        import resource  # not on Windows

        limit = resource.getrlimit(resource.RLIMIT_AS)[0]
        if limit != resource.RLIM_INFINITY:
            pages = int(Path("/proc/self/statm").read_text().split()[0])
            yield limit - pages * resource.getpagesize()
