"""Parameters of the analysis, as a case file has them."""

from __future__ import annotations

from types import SimpleNamespace

SETTINGS = SimpleNamespace(
    front_fraction=0.1,
    front_window=(12e-3, 40e-3),
    wrinkle_threshold=50e-6,
    filter_wavelength=5e-3,
    amplitude_window=(16e-3, 49e-3),
    positions=(15e-3, 25e-3, 45e-3),
)
