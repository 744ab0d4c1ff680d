"""What this machine has to offer: cores and free memory."""

import os


def cores() -> int:
    """Give the number of cores that may be used."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not on this system
        return os.cpu_count() or 1


def memory_limit() -> int:
    """Give the bytes that may be used: most of the free memory, 1 GB where that is unknown."""
    try:
        return int(0.8 * os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (ValueError, OSError, AttributeError):
        return 10**9
