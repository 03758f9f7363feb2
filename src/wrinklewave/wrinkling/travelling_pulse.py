"""An analytic surface motion: a travelling pulse with wrinkles riding on it, every number of it known.

For checks of the analysis, of the synthetic camera and of the measuring chain. The struck end is pushed at
constant speed up to a stop; every material point moves in proportion to its distance from the held end, so
the strain is the same everywhere and follows from the end's travel. A step in height of smooth shape runs
along the laboratory x at a given speed, and wrinkles grow to a given amplitude behind a front of their own,
on material points.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.laboratory_frame import Array
from wrinklewave.surface import surface_motion
from wrinklewave.wrinkling.profile import wrinkled_surface

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class TravellingPulse:
    """Parameters, SI units; the defaults resemble the impact of "Wrinkles Riding Waves".

    Attributes:
        length, half_height: of the block. n_points: number of material points along the surface.
        end_time, interval, pixel: of the record.
        velocity, travel: of the struck end.
        front_speed, rise_time, height: of the step in surface height.
        wrinkle_speed, wrinkle_rise_time, amplitude, wavelength: of the wrinkles (material wavelength).
        critical_strain: recorded for Eq. 1.
    """

    length: float = 50.4e-3
    half_height: float = 18.5e-3
    n_points: int = 203
    end_time: float = 4e-3
    interval: float = 10e-6
    pixel: float = 50e-6
    velocity: float = 10.0
    travel: float = 6.3e-3
    front_speed: float = 57.0
    rise_time: float = 1e-3
    height: float = 5e-3
    wrinkle_speed: float = 40.0
    wrinkle_rise_time: float = 0.3e-3
    amplitude: float = 150e-6
    wavelength: float = 2e-3
    critical_strain: float = 0.043

    def surface(self) -> xr.Dataset:
        """Return the surface motion."""
        time = np.arange(0.0, self.end_time + 0.5 * self.interval, self.interval)
        x = np.arange(0.0, self.length + 0.5 * self.pixel, self.pixel)
        X = np.linspace(0.0, self.length, self.n_points)
        travel = np.minimum(self.velocity * time, self.travel)[:, None]
        x_p = X + travel * (1.0 - X / self.length)
        delay = time[:, None] - x_p / self.front_speed
        y_p = self.half_height + self.height * smooth_step(delay / self.rise_time)
        wrinkle_delay = time[:, None] - x_p / self.wrinkle_speed
        amplitude = self.amplitude * smooth_step(wrinkle_delay / self.wrinkle_rise_time)
        heights = wrinkled_surface(
            X, x_p, y_p, amplitude, wavelength=self.wavelength, x=x, x_boundary=x_p[:, 0]
        )
        strain = np.broadcast_to(travel / self.length, x_p.shape)
        return surface_motion(
            time=time,
            x=x,
            X=X,
            attrs={
                "kind": "simulation",
                "name": "travelling pulse",
                "length": self.length,
                "critical_strain": self.critical_strain,
                "critical_wavelength": self.wavelength,
                "stop_distance": self.travel,
            },
            y=heights.wrinkled,
            u_y=heights.wrinkled - self.half_height,
            y_smooth=heights.smooth,
            u_y_smooth=heights.smooth - self.half_height,
            x_boundary=x_p[:, 0],
            x_p=x_p,
            y_p=y_p,
            strain_xx=strain,
            amplitude=amplitude,
        )


def smooth_step(s: Array) -> Array:
    """10 s^3 - 15 s^4 + 6 s^5 between 0 and 1: value, slope and curvature are continuous."""
    s = np.clip(s, 0.0, 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
