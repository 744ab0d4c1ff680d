"""What this machine has to offer: cores and free memory."""

import os

_processes = [1]


def share_cores(processes: int) -> None:
    """Leave the cores to so many processes alike, of which this is one."""
    _processes[0] = processes


def cores() -> int:
    """Give the number of cores that this process may use."""
    try:
        found = len(os.sched_getaffinity(0))
    except AttributeError:  # not on this system
        found = os.cpu_count() or 1
    return max(1, found // _processes[0])


def memory_limit() -> int:
    """Give the bytes that may be used: most of the free memory, 1 GB where that is unknown."""
    try:
        return int(0.8 * os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (ValueError, OSError, AttributeError):
        return 10**9
