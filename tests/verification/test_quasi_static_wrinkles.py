"""Quasi-static wrinkles against the exact inextensible film."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ellipe

from wrinklewave.wrinkling.quasi_static import wrinkle_amplitude

FILM = {"critical_strain": 0.043, "critical_wavelength": 2e-3}


@pytest.mark.parametrize("strain", [0.06, 0.08, 0.10, 0.12, 0.16, 0.20])
def test_amplitude_is_that_of_an_inextensible_film(strain: float) -> None:
    """Inextensible sinusoid y = A cos(2 pi S / lambda_c) in the arc coordinate S: its projected length is
    lambda_c (2/pi) E(q^2), q = 2 pi A / lambda_c, E the complete elliptic integral of the second kind; equal
    to lambda_c (1 - (eps - eps_c)). Eq. 1 is its series, whose next term is of order (eps - eps_c)^3."""
    excess = strain - FILM["critical_strain"]
    q = 2 * np.pi * wrinkle_amplitude(strain, **FILM) / FILM["critical_wavelength"]
    assert 2 / np.pi * ellipe(q**2) == pytest.approx(1 - excess, abs=excess**4)
