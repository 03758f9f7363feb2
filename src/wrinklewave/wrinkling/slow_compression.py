"""An analytic quasi-static compression: a block's surface at a list of strains, every number of it known.

For checks of the quasi-static test. The surface bulges as the block is compressed; its material points stay evenly
spread along the arc, so that the strain is 1 - s/L_0 everywhere. Wrinkles stand out of it along its normal (Eq. 2),
with the amplitude of Eq. 1, on material points: of an even undeformed wavelength, gone towards both ends, and from a
second strain on with every other one growing at the cost of its neighbours (period doubling).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.laboratory_frame import Array, surface_curve, visible_height
from wrinklewave.surface import surface_motion
from wrinklewave.wrinkling.profile import SAMPLES_PER_WAVELENGTH
from wrinklewave.wrinkling.quasi_static import wrinkle_amplitude
from wrinklewave.wrinkling.travelling_pulse import smooth_step

if TYPE_CHECKING:
    import xarray as xr

ARC_SAMPLES = 4001


@dataclass(frozen=True)
class SlowCompression:
    """Parameters, SI units; the defaults resemble the quasi-static test of "Wrinkles Riding Waves".

    Attributes:
        strains: along the arc, one for each image.
        length, half_height: of the block.
        bulge: rise of the middle over half_height, per strain.
        critical_strain, wavelength: eps_c and lambda_c (undeformed) of Eq. 1. initial_amplitude: of wrinkles that
            are there before.
        margins: undeformed distances from the struck and the held end within which wrinkles are suppressed: half
            their amplitude is reached there.
        doubling_strain, doubling: from that strain on a wave of twice the wavelength grows in proportion to the
            excess strain, up to the share ``doubling`` of the amplitude at the last strain; never if None.
        n_points, pixel: material points, and the spacing of the laboratory grid.
    """

    strains: tuple[float, ...] = tuple(np.linspace(0.0, 0.2, 41).tolist())
    length: float = 50.4e-3
    half_height: float = 18.5e-3
    bulge: float = 0.5
    critical_strain: float = 0.043
    wavelength: float = 2e-3
    initial_amplitude: float = 0.0
    margins: tuple[float, float] = (0.0, 0.0)
    doubling_strain: float | None = None
    doubling: float = 0.3
    n_points: int = 203
    pixel: float = 50e-6

    def surface(self) -> xr.Dataset:
        """Return the surface motion; its times count the images."""
        strains = np.asarray(self.strains, dtype=float)
        x = np.arange(0.0, self.length + 0.5 * self.pixel, self.pixel)
        X = np.linspace(0.0, self.length, self.n_points)
        x_p, y_p = (np.stack(rows) for rows in zip(*(self._points(eps) for eps in strains), strict=True))
        curve = surface_curve(X, x_p, y_p, spacing=min(self.wavelength / SAMPLES_PER_WAVELENGTH, self.pixel))
        wrinkle = self._wrinkles(strains[:, None], curve.X)
        boundary = x_p[:, 0]
        y = visible_height(
            curve.x + wrinkle * curve.normal_x, curve.y + wrinkle * curve.normal_y, x, boundary
        )
        smooth = visible_height(curve.x, curve.y, x, boundary)
        return surface_motion(
            time=np.arange(strains.size),
            x=x,
            X=X,
            attrs={
                "kind": "simulation",
                "name": "slow compression",
                "procedure": "quasi-static",
                "length": self.length,
                "critical_strain": self.critical_strain,
                "critical_wavelength": self.wavelength,
            },
            y=y,
            u_y=y - self.half_height,
            y_smooth=smooth,
            u_y_smooth=smooth - self.half_height,
            x_boundary=boundary,
            x_p=x_p,
            y_p=y_p,
            strain_xx=np.broadcast_to(strains[:, None], x_p.shape),
            amplitude=np.broadcast_to(self.amplitude(strains)[:, None], x_p.shape),
        )

    def amplitude(self, strains: Array) -> Array:
        """Amplitude of the wrinkles in the middle of the sample [m], same shape."""
        return wrinkle_amplitude(
            strains,
            critical_strain=self.critical_strain,
            critical_wavelength=self.wavelength,
            initial_amplitude=self.initial_amplitude,
        )

    def _wrinkles(self, strains: Array, X: Array) -> Array:
        """Heights of the wrinkles along the normal [m], shape [n_strains, n_X]."""
        phase = 2.0 * np.pi * X / self.wavelength
        heights = self.amplitude(strains) * np.cos(phase)
        if self.doubling_strain is not None:
            full = max(self.strains) - self.doubling_strain
            share = self.doubling * np.maximum(strains - self.doubling_strain, 0.0) / full
            heights = heights + share * self.amplitude(strains) * np.cos(0.5 * phase)
        for margin, away in zip(self.margins, (X, self.length - X), strict=True):
            if margin > 0.0:
                heights = heights * smooth_step(away / margin - 0.5)
        return heights

    def _points(self, strain: float) -> tuple[Array, Array]:
        """Positions of material points on a bulge of the right arc length, [n_points] each."""
        from scipy.optimize import brentq

        share = np.linspace(0.0, 1.0, ARC_SAMPLES)
        height = self.half_height * (1.0 + self.bulge * strain * (1.0 - (2.0 * share - 1.0) ** 4))

        def arc(chord: float) -> Array:
            steps = np.hypot(chord * np.diff(share), np.diff(height))
            return np.concatenate([[0.0], np.cumsum(steps)])

        goal = self.length * (1.0 - strain)
        chord = brentq(lambda c: arc(c)[-1] - goal, 0.3 * self.length, self.length, xtol=1e-15)
        along = np.linspace(0.0, goal, self.n_points)
        return (
            self.length - chord + chord * np.interp(along, arc(chord), share),
            np.interp(along, arc(chord), height),
        )
