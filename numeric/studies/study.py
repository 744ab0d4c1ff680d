"""What all studies are: rows, as arrays and in files, plain data, and one picture."""

from functools import cached_property
from typing import TYPE_CHECKING, Any

from .. import tables
from ..arithmetic.systems import Array
from ..figures.library import drawn
from ..figures.specification import Picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Study:
    """What was measured, once; its name is that of its files."""

    name: str

    def rows(self) -> list[tables.Row]:
        """One row for each measurement, ready for a data frame."""
        raise NotImplementedError

    def data(self) -> dict[str, Any]:
        """Give it as JSON can hold it."""
        raise NotImplementedError

    def picture(self) -> Picture:
        """Say what is drawn of it."""
        raise NotImplementedError

    @cached_property
    def arrays(self) -> dict[str, Array]:
        """The columns of ``rows``, each of shape (rows,); NaN where there is no number."""
        return tables.columns_of(self.rows())

    def files(self) -> dict[str, list[tables.Row]]:
        """Give the rows of each CSV file by its name."""
        return {f"{self.name}.csv": self.rows()}

    def plot(self) -> "Figure":
        """Draw it. Needs matplotlib (the extra ``plots``). Raises ``MissingLibraryError``."""
        return drawn(self.picture())
