"""What blur along the row does to the edge: columns see their neighbours.

The column at x sees the mixture of the profiles of its neighbours, weighted by the lateral blur g (the
optics', of standard deviation s, and the pixel's width). The least-squares fit of a single profile of blur
sigma to the mixture lies where sum_n g_n Phi((delta - d_n)/T) = 1/2, with d_n = y(x + n) - y(x) and T^2 =
s^2 + sigma^2 + 1/6. For small curvature y'' this is delta = y'' v/2, v = (s^2 + 1/12) (1 + m^2/2)/(1 + m^2)
at the slope m: a linear operator B of local blurs v. See docs/measurement_theory.md.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wrinklewave._jit import allocating, uintp, vector
from wrinklewave.imaging.arrays import Floats
from wrinklewave.imaging.edges.banded import LANES, add_product
from wrinklewave.imaging.edges.profile import normal_distribution

_SHARES = 17  # table of blurs between v/2 (steep) and v (level)
_STEPS = 2


def lateral_kernels(blur: float) -> NDArray[np.float64]:
    """Kernels of the lateral blur for ``_SHARES`` variances from v/2 to v = blur^2 + 1/12, shape [_SHARES, 2
    n + 1].

    The kernel of variance v is exp(-v) I_n(v), the diffusion kernel of a row of pixels.
    """
    from scipy.special import ive

    v = blur**2 + 1 / 12
    reach = LANES // 2 * int(np.ceil(3.2 * np.sqrt(v) / (LANES // 2)))  # a narrower band would save nothing
    shares = v * np.linspace(0.5, 1.0, _SHARES)
    kernels = ive(np.arange(-reach, reach + 1)[None, :], shares[:, None])
    return np.array([_of_variance(kernel, share) for kernel, share in zip(kernels, shares, strict=True)])


@allocating
def _of_variance(kernel: Floats, variance: float) -> Floats:
    """The kernel with a sum of one and exactly this variance, whatever its ends lack."""
    reach = kernel.size // 2
    exact = kernel * variance / np.sum(kernel * np.arange(-reach, reach + 1) ** 2)
    exact[reach] += 1.0 - exact.sum()
    return exact


@allocating
def local_kernels(slope: Floats, kernels: Floats) -> Floats:
    """Rows of B, shape [2 reach + 1, n], for the slopes at n columns."""
    local = np.empty((kernels.shape[1], slope.size))
    place = (_SHARES - 1) / (1.0 + slope**2)  # (1 + m2/2)/(1 + m2) = 1/2 + 1/2 1/(1 + m2)
    for j in range(kernels.shape[1]):
        _interpolate(kernels[:, j].copy(), place, local[j])
    return local


@vector
def _interpolate(table: Floats, place: Floats, values: Floats) -> None:
    for i in range(uintp(place.size)):
        k = min(np.int32(place[i]), np.int32(_SHARES - 2))
        r, f = uintp(k), place[i] - k
        values[i] = table[r] + f * (table[r + uintp(1)] - table[r])


@allocating
def seen_linearly(surface: Floats, local: Floats) -> Floats:
    """B y at the n columns of ``local``; the surface goes on ``reach`` columns further on both sides."""
    width, n = local.shape
    seen = np.zeros(n)
    for j in range(width):
        add_product(local[j], surface[j : j + n], seen)
    return seen


@allocating
def seen_exactly(surface: Floats, linear: Floats, slope: Floats, blur: float) -> Floats:
    """Where columns see the surface: Newton's steps from the linear answer, steep as a normal mixture."""
    n = linear.size
    width = surface.size - n + 1
    v = blur * blur + 1.0 / 12.0
    share = _of_variance(np.exp(-0.5 * (np.arange(width) - width // 2) ** 2 / v), v)
    per_T = 1.0 / np.sqrt(v * (2.0 + slope**2))
    steepness = np.sqrt(4.0 * np.pi * v * (1.0 + slope**2))
    seen, below = linear.copy(), np.empty(n)
    for _ in range(_STEPS):
        below[:] = 0.0
        for j in range(width):
            _add_share_below(seen, surface[j : j + n], per_T, share[j], below)
        seen += (0.5 - below) * steepness
    return seen


@vector
def _add_share_below(seen: Floats, surface: Floats, per_T: Floats, share: float, below: Floats) -> None:
    """What a neighbour adds to the mixture at the rows that are seen."""
    for i in range(uintp(seen.size)):
        below[i] += share * normal_distribution((seen[i] - surface[i]) * per_T[i])[0]
