"""Runs an ensemble: what is missing is solved, kept as it comes, and looked at in a fixed order."""

from bisect import bisect_left, insort
from collections.abc import Callable, Iterator
from typing import Protocol

from ..statistics.confidence import Rule, looks
from .measure import Measurement
from .network_result import NetworkEnsemble, NetworkEstimates, estimates_of
from .result import Ensemble
from .store import Block, Store, StoreError
from .sums import AnySums, of_none
from .workers import refuse_unbuildable

# Beads of a block, about; of a large ensemble more, as long as there are so many blocks for workers
# to share: a second of work at most, compiled or not, of which a kill loses no more.
BLOCK, SHARES = 1_000_000, 32
LARGE = {True: 64_000_000, False: 8_000_000}
# Numbers that large blocks keep of all their packings, those of a group, until they are summed up.
MEANS = 2_000_000


class Executor(Protocol):
    """Something that sums up ranges of realisations."""

    def results(
        self, m: Measurement, tasks: Iterator[tuple[int, int]]
    ) -> Iterator[tuple[int, int, AnySums]]:
        """Give (first, stop, sums) of every task, in any order; tasks are taken as needed."""


def run(
    m: Measurement,
    size: int,
    executor: Executor,
    *,
    store: Store | None = None,
    rule: Rule | None = None,
    confidence: float = 0.95,
    progress: Callable[[int, float | None], None] = lambda done, width: None,
) -> Ensemble:
    """Sum up realisations 0 … size − 1, or fewer where the rule is met at a look before.

    ``progress`` is told how many realisations are done, and the half-width at the last look. Raises
    ``StoreError``, and what the executor raises; what a store holds by then stays good.
    """
    return _Run(m, size, store, rule, confidence, progress).finish(executor)


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
        ends = set() if store is None else set(store.about.ends)
        last = max([size, *(block.stop for block in self.blocks)])
        self.looks = list(looks(size))
        self.cuts = sorted({*looks(2 * last), *ends, size})
        self._refuse_straddling()
        if store is not None:
            store.add_end(size)
        self.prefix, self.look = of_none(m), 0
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

    def finish(self, executor: Executor) -> Ensemble:
        """Solve what is missing until the size or the rule is reached."""
        self.progress(self._done(), None)
        if not self._advance():
            for first, stop, sums in executor.results(self.m, self._tasks()):
                self.solved += stop - first
                self._keep(Block(first, stop, sums))
                ended = self._advance()
                self.progress(self._done(), self.width)
                if ended:
                    break
        refuse_unbuildable(self.m, self.prefix)
        estimates = estimates_of(self.m, self.prefix)
        reached = None
        look = self.look
        if self.rule is not None:
            if self.prefix.tried not in self.looks:
                look += 1  # the size itself is looked at last
            reached = estimates.half_width(self.confidence, look) <= self.rule.relative
        width = estimates.half_width(self.confidence, look if self.rule is not None else 0)
        kind: type[Ensemble] = Ensemble
        if isinstance(estimates, NetworkEstimates):
            kind = NetworkEnsemble
        return kind(
            estimates, self.confidence, look if self.rule else 0, width, reached, self.solved
        )

    def _done(self) -> int:
        return sum(min(block.stop, self.size) - block.first
                   for block in self.blocks if block.first < self.size)  # fmt: skip

    def _tasks(self) -> Iterator[tuple[int, int]]:
        """Give the ranges that are missing, in order; none lies across a cut."""
        beads = max(self.m.problem.region.beads, 1)
        large = min(
            LARGE[self.m.compiled] // beads, self.size // SHARES, MEANS // max(self.m.groups, 1)
        )
        step = max(1, min(BLOCK // beads, 4096), large)
        if self.m.of_networks:  # each takes a second, or many
            step = 1
        known = [(block.first, block.stop) for block in self.blocks]
        at = 0
        while at < self.size:
            held = next((stop for first, stop in known if first <= at < stop), None)
            if held is not None:
                at = held
                continue
            barriers = (first for first, _ in known if first > at)
            cut = self.cuts[bisect_left(self.cuts, at + 1)]
            stop = min(at + step - at % step, cut, self.size, *barriers)
            yield at, stop
            at = stop

    def _keep(self, block: Block) -> None:
        """Merge a block with its neighbours as far as no cut lies between; write that."""
        merged = []
        for old in self.blocks:
            beside = old.stop == block.first or old.first == block.stop
            edge = block.first if old.stop == block.first else block.stop
            if beside and edge not in self.cuts:
                first, stop = min(old.first, block.first), max(old.stop, block.stop)
                block = Block(first, stop, old.sums + block.sums)
                merged.append(old)
        for old in merged:
            self.blocks.remove(old)
        insort(self.blocks, block, key=lambda one: one.first)
        if self.store is not None and block.sums.realisations:  # none: a wrong scene is no result
            self.store.put(block, merged)

    def _advance(self) -> bool:
        """Take in what follows without a gap, cut by cut; say whether the ensemble is finished."""
        while self.prefix.tried < self.size:
            at = self.prefix.tried
            cut = self.cuts[bisect_left(self.cuts, at + 1)]
            between = [block for block in self.blocks if at <= block.first < cut]
            if sum(block.stop - block.first for block in between) < cut - at:
                return False
            for block in between:
                self.prefix = self.prefix + block.sums
            if cut in self.looks and self.rule is not None:
                self.look += 1
                estimates = estimates_of(self.m, self.prefix)
                self.width = estimates.half_width(self.confidence, self.look)
                if self.width <= self.rule.relative:
                    return True
        return True
