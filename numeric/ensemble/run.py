"""Runs an ensemble: what is missing is solved, kept as it comes, and looked at in a fixed order."""

from bisect import bisect_right, insort
from collections.abc import Callable, Iterator

from ..arithmetic.errors import NOT_REACHED, ForceDiffusionError, UndecidedError
from ..statistics.confidence import Rule, looks
from ..unilateral.network import UnfinishedError
from .estimates import Estimates
from .measure import Measurement
from .result import Ensemble
from .store import Store, StoreError
from .sums import Block, Sums, joined, nothing, ranges, total, why_left_out
from .workers import Workers, solved

# Beads of a block, about; of a large ensemble more, as long as there are so many blocks for workers
# to share: a second of work at most, compiled or not, of which a kill loses no more.
BLOCK, SHARES = 1_000_000, 32
LARGE = {True: 64_000_000, False: 8_000_000}
# Numbers that large blocks keep of all their packings, those of a group, until they are summed up.
MEANS = 2_000_000


class RealisationError(ForceDiffusionError, ValueError):
    """Hardly a realisation can be built; the message says which can't, and why."""


class UnsettledError(RealisationError):
    """Hardly a packing comes to rest, or is proved to, within what was asked."""

    exit_status = NOT_REACHED


def run(
    m: Measurement,
    size: int,
    workers: Workers,
    *,
    store: Store | None = None,
    rule: Rule | None = None,
    confidence: float = 0.95,
    progress: Callable[[int, float | None], None] = lambda done, width: None,
) -> Ensemble:
    """Sum up realisations 0 … size − 1, or fewer where the rule is met at a look before.

    ``progress`` is told how many realisations are done, and the half-width at the last look. Raises
    ``StoreError``, and what the workers raise; what a store holds by then stays good.
    """
    return _Run(m, size, store, rule, confidence, progress).finish(workers)


class _Run:
    def __init__(
        self,
        m: Measurement,
        size: int,
        store: Store | None,
        rule: Rule | None,
        confidence: float,
        progress: Callable[[int, float | None], None],
    ) -> None:
        self.m, self.size, self.store, self.rule = m, size, store, rule
        self.confidence = confidence if rule is None else rule.confidence
        self.progress = progress
        self.blocks = [] if store is None else store.blocks(m)
        self._refuse_straddling()
        if store is not None:
            store.begin(size, self.blocks)
        ends = () if store is None else store.about.ends
        last = max([size, *(block.stop for block in self.blocks)])
        # Where ranges begin and end that are looked at, or were asked for: none lies across.
        self.cuts = sorted({*looks(2 * last), *ends, size})
        self.looks = list(looks(size))
        self.sums, self.look = nothing(m, 1)[0], 0
        self.width: float | None = None
        self.solved = 0

    def _refuse_straddling(self) -> None:
        for block in self.blocks:
            if block.first < self.size < block.stop:
                assert self.store is not None
                raise StoreError(
                    f"{self.store.path} holds sums over realisations {block.first} to "
                    f"{block.stop - 1}, of which {self.size} would need a part: ask for "
                    f"{block.first or block.stop} or {block.stop}, or give another name"
                )

    def finish(self, workers: Workers) -> Ensemble:
        """Solve what is missing until the size or the rule is reached."""
        self.progress(self._done(), None)
        if not self._advance():
            for block in solved(self.m, self._tasks(), workers):
                self.solved += block.stop - block.first
                self._keep(block)
                ended = self._advance()
                self.progress(self._done(), self.width)
                if ended:
                    break
        _refuse_unbuildable(self.m, self.sums)
        estimates = Estimates(self.m, self.sums)
        look, reached = 0, None
        if self.rule is not None:
            # the size itself is looked at last
            look = self.look + (self.sums.tried not in self.looks)
            reached = estimates.width(self.confidence, look) <= self.rule.relative
        width = estimates.width(self.confidence, look)
        return Ensemble(self.m, self.sums, self.confidence, look, width, reached, self.solved)

    def _done(self) -> int:
        return sum(min(block.stop, self.size) - block.first
                   for block in self.blocks if block.first < self.size)  # fmt: skip

    def _tasks(self) -> Iterator[tuple[int, int]]:
        """Give the blocks that are missing, in order."""
        beads = max(self.m.problem.region.beads, 1)
        large = min(
            LARGE[self.m.compiled] // beads, self.size // SHARES, MEANS // max(self.m.groups, 1)
        )
        step = max(1, min(BLOCK // beads, 4096), large)
        if self.m.of_networks:  # each takes a second, or many
            step = 1
        step = 1 << (step.bit_length() - 1)
        held = {block.first: block.stop for block in self.blocks}
        ends, at = sorted({*self.cuts, *held}), 0
        while at < self.size:
            stop = held.get(at) or ends[bisect_right(ends, at)]
            if at not in held:
                yield from ranges(at, stop, step)
            at = stop

    def _keep(self, block: Block) -> None:
        """Join a block with its neighbours as far as no range ends between; write that."""
        insort(self.blocks, block, key=lambda one: one.first)
        self.blocks = joined(self.blocks, self.cuts)
        whole = next(one for one in self.blocks if one.first <= block.first < one.stop)
        if self.store is not None and whole.sums.realisations:  # none: a wrong scene is no result
            self.store.put(whole)

    def _advance(self) -> bool:
        """Look at all sizes up to which nothing is missing; say whether that is enough."""
        done = 0
        for block in self.blocks:
            done = block.stop if block.first == done else done
        while self.rule is not None and self.look < len(self.looks):
            size = self.looks[self.look]
            if size > done:
                break
            self.look += 1
            self.width = self._sum_up(size).width(self.confidence, self.look)
            if self.width <= self.rule.relative:
                return True
        if done < self.size:
            return False
        self._sum_up(self.size)
        return True

    def _sum_up(self, size: int) -> Estimates:
        self.sums = total(self.m, [block for block in self.blocks if block.stop <= size])
        return Estimates(self.m, self.sums)


def _refuse_unbuildable(m: Measurement, sums: Sums) -> None:
    """Raise ``RealisationError`` where no two packings are left, and say why one can't be built."""
    if sums.realisations >= 2:
        return
    number = sums.first_unbuildable or 0
    why = why_left_out(m, number)
    unsettled = isinstance(why, UnfinishedError | UndecidedError)
    raise (UnsettledError if unsettled else RealisationError)(
        f"{sums.unbuildable} of {sums.tried} packings are left out, and statistics need two: "
        f"realisation {number}: {why}"
    )
