"""Runs an ensemble: what is missing is solved, kept as it comes, and looked at in a fixed order."""

from bisect import bisect_right, insort
from collections.abc import Callable, Iterator
from itertools import chain

from ..arithmetic.errors import ForceDiffusionError
from ..statistics.confidence import Rule, looks
from .estimates import Estimates
from .measure import Measurement
from .result import Ensemble
from .store import Store, StoreError
from .sums import Block, Sums, joined, ranges, total, why_left_out
from .workers import Workers, solved

# Beads of a block, about; of a large ensemble more, as long as there are so many blocks for workers
# to share: a second of work at most, compiled or not, of which a kill loses no more.
BLOCK, SHARES = 1_000_000, 32
LARGE = {True: 64_000_000, False: 8_000_000}
# Numbers that large blocks keep of all their packings, those of a group, until they are summed up.
MEANS = 2_000_000


class RealisationError(ForceDiffusionError, ValueError):
    """Hardly a realisation can be built; the message says which can't, and why."""


Told = Callable[[int, float | None], None]
"""Told how many realisations are done, and the half-width at the last look."""


def run(
    m: Measurement,
    size: int,
    workers: Workers,
    *,
    store: Store | None = None,
    rule: Rule | None = None,
    confidence: float = 0.95,
    progress: Told = lambda done, width: None,
) -> Ensemble:
    """Sum up realisations 0 … size − 1, or fewer where the rule is met at a look before.

    Raises ``StoreError``, and what the workers raise; what a store holds by then stays good.
    """
    confidence = confidence if rule is None else rule.confidence
    blocks = _Blocks(m, size, store)
    sizes = [] if rule is None else list(looks(size))
    look, solved_now, met = 0, 0, False
    width: float | None = None
    progress(blocks.done, None)
    for block in chain([None], solved(m, blocks.missing(), workers)):
        if block is not None:
            solved_now += block.stop - block.first
            blocks.keep(block)
        done = blocks.without_gap
        while rule is not None and not met and look < len(sizes) and sizes[look] <= done:
            found = Estimates(m, blocks.sums(sizes[look]))
            look += 1
            width = found.width(confidence, look)
            met = width <= rule.relative
        if block is not None:
            progress(blocks.done, width)
        if met or done >= size:
            break
    if not met:
        found = Estimates(m, blocks.sums(size))
    _refuse_unbuildable(m, found.sums)
    if rule is not None:  # the size itself is looked at last
        look += found.sums.tried not in sizes
    last = found.width(confidence, look)
    reached = None if rule is None else last <= rule.relative
    return Ensemble(m, found.sums, confidence, look, last, reached, solved_now)


class _Blocks:
    """The blocks of an ensemble: those of the store, and those that come."""

    def __init__(self, m: Measurement, size: int, store: Store | None) -> None:
        self.m, self.size, self.store = m, size, store
        self._all = [] if store is None else store.blocks(m)
        for block in self._all:
            if store is not None and block.first < size < block.stop:
                raise StoreError(
                    f"{store.path} holds sums over realisations {block.first} to "
                    f"{block.stop - 1}, of which {size} would need a part: ask for "
                    f"{block.first or block.stop} or {block.stop}, or give another name"
                )
        if store is not None:
            store.begin(size)
        ends = () if store is None else store.about.ends
        last = max([size, *(block.stop for block in self._all)])
        # Where ranges begin and end that are looked at, or were asked for: none lies across.
        self.cuts = sorted({*looks(2 * last), *ends, size})

    @property
    def done(self) -> int:
        """How many realisations there are, of those asked for."""
        asked = (block for block in self._all if block.first < self.size)
        return sum(min(block.stop, self.size) - block.first for block in asked)

    @property
    def without_gap(self) -> int:
        """Up to which realisation none is missing."""
        done = 0
        for block in self._all:
            done = block.stop if block.first == done else done
        return done

    def sums(self, size: int) -> Sums:
        """Give the sums over the first realisations."""
        return total(self.m, [block for block in self._all if block.stop <= size])

    def missing(self) -> Iterator[tuple[int, int]]:
        """Give the blocks that are missing, in order."""
        m, beads = self.m, max(self.m.problem.region.beads, 1)
        large = min(LARGE[m.compiled] // beads, self.size // SHARES, MEANS // max(m.groups, 1))
        step = max(1, min(BLOCK // beads, 4096), large)
        step = 1 << (step.bit_length() - 1)
        held = {block.first: block.stop for block in self._all}
        ends, at = sorted({*self.cuts, *held}), 0
        while at < self.size:
            stop = held.get(at) or ends[bisect_right(ends, at)]
            if at not in held:
                yield from ranges(at, stop, step)
            at = stop

    def keep(self, block: Block) -> None:
        """Join a block with its neighbours as far as no range ends between; write that."""
        insort(self._all, block, key=lambda one: one.first)
        self._all = joined(self._all, self.cuts)
        whole = next(one for one in self._all if one.first <= block.first < one.stop)
        if self.store is not None and whole.sums.realisations:  # none: a wrong scene is no result
            self.store.put(whole)


def _refuse_unbuildable(m: Measurement, sums: Sums) -> None:
    """Raise ``RealisationError`` where no two packings are left, and say why one can't be built."""
    if sums.realisations >= 2:
        return
    number = sums.first_unbuildable or 0
    raise RealisationError(
        f"{sums.unbuildable} of {sums.tried} packings are left out, and statistics need two: "
        f"realisation {number}: {why_left_out(m, number)}"
    )
