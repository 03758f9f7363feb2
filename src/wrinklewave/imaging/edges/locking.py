"""Pixel locking: whether edges are drawn towards certain places between two rows of pixels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

N_BINS = 10


@dataclass(frozen=True)
class PixelLocking:
    """Residuals against the sub-pixel phase, gathered frame by frame.

    The residual is a column's own row less the regularised surface, the phase where the latter (as the column
    sees it) lies between two rows. Without pixel locking its mean is zero at every phase.

    Attributes:
        count, total, squares: number, sum and sum of squares of residuals in ``N_BINS`` bins of the phase.
    """

    count: NDArray[np.float64]
    total: NDArray[np.float64]
    squares: NDArray[np.float64]

    @classmethod
    def none(cls) -> PixelLocking:
        """Before the first frame."""
        return cls(*(np.zeros(N_BINS) for _ in range(3)))

    @classmethod
    def of(cls, phase_rows: NDArray[np.float64], residual: NDArray[np.float64]) -> PixelLocking:
        """From one frame: rows of the surface and residuals [px], shape [n_columns], NaN where unknown."""
        known = np.isfinite(phase_rows) & np.isfinite(residual)
        bins = (np.mod(phase_rows[known], 1.0) * N_BINS).astype(int) % N_BINS
        values = residual[known]
        count, total, squares = (np.bincount(bins, values**k, N_BINS).astype(float) for k in (0, 1, 2))
        return cls(count, total, squares)

    def __add__(self, other: PixelLocking) -> PixelLocking:
        return PixelLocking(self.count + other.count, self.total + other.total, self.squares + other.squares)

    @property
    def mean(self) -> NDArray[np.float64]:
        """Mean residual per bin of the phase [px]; NaN where there are none."""
        with np.errstate(invalid="ignore"):
            return self.total / self.count

    @property
    def mean_sigma(self) -> NDArray[np.float64]:
        """Standard uncertainty of ``mean`` [px]."""
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.sqrt((self.squares / self.count - self.mean**2) / self.count)

    @property
    def amplitude(self) -> float:
        """Root mean square over the phase of the mean residual, freed of the part that noise makes [px]."""
        known = self.count > 1
        if not known.any():
            return float("nan")
        excess = float(np.mean(self.mean[known] ** 2 - self.mean_sigma[known] ** 2))
        return float(np.sqrt(max(excess, 0.0)))
