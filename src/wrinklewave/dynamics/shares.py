"""Which rows of elements each thread takes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.dynamics.barrier import LINE

if TYPE_CHECKING:
    from numpy.typing import NDArray

SURFACE = 0.7
"""What the last row of nodes and the conditions at the surface cost, in rows of elements."""


def shares_of(counts: NDArray[np.int64], parts: int) -> NDArray[np.int64]:
    """First row of each thread's share, and the number of rows, shape [parts + 1]: shares of about the same work.

    ``counts`` [n_rows] are how often each row of elements is computed; each of ``parts`` threads has one row at least.
    """
    work = counts.astype(float)
    work[-1] += SURFACE * counts[-1]
    done, rows = np.cumsum(work), counts.size
    wanted = done[-1] * np.arange(parts + 1) / parts
    shares = 1 + np.abs(done[:, None] - wanted).argmin(axis=0)
    shares[0], shares[-1] = 0, rows
    for part in range(1, parts):
        shares[part] = min(max(shares[part], shares[part - 1] + 1), rows - parts + part)
    return shares


def shared_out(field: NDArray, parts: int) -> dict[str, NDArray]:
    """Of :class:`~wrinklewave.dynamics.step.Arrays`, those that ``parts`` threads need for a mesh.

    ``field`` is a nodal one, shape [n_rows + 1, n_columns + 1], in the precision of the state.
    """
    rows, columns = field.shape[0] - 1, field.shape[1] - 1
    parts = min(parts, rows)
    return {
        "shares": shares_of(np.ones(rows, np.int64), parts),
        "forces": np.zeros((parts, 4, 8, columns + 2), field.dtype),
        "counts": np.zeros((3, parts * LINE), dtype=np.int64),
    }
