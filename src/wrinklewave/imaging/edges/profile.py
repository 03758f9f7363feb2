"""The profile of a blurred edge along a column of pixels, and its tables.

A step blurred by a Gaussian of standard deviation s and integrated over pixels of height 1 has the profile
E(u) = s [G((u + 1/2)/s) - G((u - 1/2)/s)], G(t) = t Phi(t) + phi(t), at the distance u of the pixel's centre
from the edge; its derivative is Phi((u + 1/2)/s) - Phi((u - 1/2)/s). Phi and phi are the normal distribution
and density.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wrinklewave._jit import allocating
from wrinklewave.imaging.arrays import Floats

_REACH = 6.0  # Phi(-6) = 1e-9
_PER_UNIT = 128  # linear interpolation at this spacing is good to 3e-6 of the step


def _tables() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    from scipy.special import ndtr

    t = np.linspace(-_REACH, _REACH, int(2 * _REACH * _PER_UNIT) + 1)
    Phi = ndtr(t)
    return Phi, t * Phi + np.exp(-0.5 * t**2) / np.sqrt(2 * np.pi)


_PHI, _G = _tables()


@allocating
def normal_distribution(t: float) -> tuple[float, float]:
    """Phi(t) and its integral G(t), from the tables."""
    if t <= -_REACH:
        return 0.0, 0.0
    if t >= _REACH:
        return 1.0, t
    position = (t + _REACH) * _PER_UNIT
    k = int(position)
    f = position - k
    return _PHI[k] + f * (_PHI[k + 1] - _PHI[k]), _G[k] + f * (_G[k + 1] - _G[k])


def blurred_step(u: Floats, blur: float) -> Floats:
    """Profile E at the distances ``u`` from the edge [px], for a blur [px]."""

    def G(t: Floats) -> Floats:
        from scipy.special import ndtr

        return np.asarray(t * ndtr(t) + np.exp(-0.5 * t**2) / np.sqrt(2 * np.pi))

    return blur * (G((u + 0.5) / blur) - G((u - 0.5) / blur))
