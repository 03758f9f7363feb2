"""The profile of a blurred edge along a column of pixels.

A step blurred by a Gaussian of standard deviation s and integrated over pixels of height 1 has the profile
E(u) = s [G((u + 1/2)/s) - G((u - 1/2)/s)], G(t) = t Phi(t) + phi(t), at the distance u of the pixel's centre
from the edge; its derivative is Phi((u + 1/2)/s) - Phi((u - 1/2)/s). Phi and phi are the normal distribution
and density.
"""

from __future__ import annotations

import numpy as np

from wrinklewave._jit import scalar
from wrinklewave.imaging.arrays import Floats

_FARTHEST = 18.0  # t^2/2 beyond which phi stays what it is, 6e-9


@scalar
def normal_distribution(t: float) -> tuple[float, float]:
    """Phi(t) and its integral G(t), good to 1e-7 and 1e-6, without a branch or a table: loops of it become vectors.

    phi is the 16th power of a polynomial fitted to exp(-t^2/32), Phi Hastings' approximation (Abramowitz and Stegun,
    26.2.17).
    """
    x = min(0.5 * t * t, _FARTHEST) * 0.0625
    e = 1.0 + x * (
        -0.9999998590772746
        + x
        * (
            0.4999971159429239
            + x
            * (
                -0.16664608114497392
                + x
                * (
                    0.041595336090998636
                    + x * (-0.008198047825897753 + x * (0.001243501926340873 - x * 0.00011252538102787812))
                )
            )
        )
    )
    e *= e
    e *= e
    e *= e
    density = 0.3989422804014327 * e * e
    k = 1.0 / (1.0 + 0.2316419 * abs(t))
    tail = (
        density
        * k
        * (0.319381530 + k * (-0.356563782 + k * (1.781477937 + k * (-1.821255978 + k * 1.330274429))))
    )
    distribution = tail if t < 0.0 else 1.0 - tail
    return distribution, t * distribution + density


@scalar
def blurred_step_at(u: float, blur: float) -> tuple[float, float]:
    """Profile E at the distance ``u`` from the edge [px], and its derivative, with the approximations above."""
    upper, upper_integral = normal_distribution((u + 0.5) / blur)
    lower, lower_integral = normal_distribution((u - 0.5) / blur)
    return blur * (upper_integral - lower_integral), upper - lower


def blurred_step(u: Floats, blur: float) -> Floats:
    """Profile E at the distances ``u`` from the edge [px], for a blur [px]."""

    def G(t: Floats) -> Floats:
        from scipy.special import ndtr

        return np.asarray(t * ndtr(t) + np.exp(-0.5 * t**2) / np.sqrt(2 * np.pi))

    return blur * (G((u + 0.5) / blur) - G((u - 0.5) / blur))
