"""How fast wrinkles grow at a given compression: exact, with inertia and with relaxing moduli.

Film and substrate have been compressed to the same strain and have relaxed. A small wrinkle of wavenumber k then
grows as exp(s t), with s the largest real root of

    det Z(strain, k h, s) = 0,

Z the surface stiffness of :mod:`wrinklewave.theory.bifurcation` with the moduli mu(s), K(s) and the inertia rho s^2.
Both make every increment stiffer as s grows, so the lowest eigenvalue of Z rises with s and has one zero at most.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wrinklewave.errors import InputError
from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.theory.bifurcation import surface_stiffness

SLOWEST_RATE = 1e-6
"""[1/s]; slower growth is reported as none."""


@dataclass(frozen=True)
class FastestGrowth:
    """The wrinkle that grows fastest at one strain.

    ``rate`` is in 1/s; ``wavenumber`` [1/m] and ``wavelength`` [m] are those of the undeformed state.
    """

    rate: float
    wavenumber: float

    @property
    def wavelength(self) -> float:
        return 2 * np.pi / self.wavenumber


def growth_rate(
    film: Viscoelastic, substrate: Viscoelastic, strain: float, wavenumber: float, *, thickness: float
) -> float:
    """Rate s [1/s] at which a small wrinkle grows; 0 if it does not.

    Args:
        film, substrate: K_inf = inf stands for an incompressible solid, of which only the shear relaxes.
        strain: nominal compressive strain, held until everything has relaxed.
        wavenumber: k of the undeformed state [1/m].
        thickness: of the film [m].

    Raises:
        InputError: if nothing has a mass, so that nothing limits the rate.
    """
    from scipy.optimize import brentq

    def softest(log_rate: float) -> float:
        Z = surface_stiffness(
            film, substrate, strain, wavenumber, thickness=thickness, rate=float(np.exp(log_rate))
        )
        return float(np.linalg.eigvalsh(0.5 * (Z + Z.T))[0])

    density = max(film.density, substrate.density)
    if density <= 0:
        raise InputError(
            "neither film nor substrate has a mass", key="density", expected="a positive density"
        )
    shear_speed = np.sqrt(film.mu_instantaneous / density)
    slow, fast = np.log(SLOWEST_RATE), np.log(shear_speed / thickness)
    if softest(slow) >= 0:
        return 0.0
    return float(np.exp(brentq(softest, slow, fast, xtol=1e-13, rtol=1e-14)))


def fastest_growth(
    film: Viscoelastic, substrate: Viscoelastic, strain: float, *, thickness: float
) -> FastestGrowth:
    """Growth rate and wavelength of the fastest wrinkle; arguments as in :func:`growth_rate`.

    Raises:
        InputError: if no wrinkle grows at this strain.
    """
    from scipy.optimize import minimize_scalar

    def slowness(kh: float) -> float:
        return -growth_rate(film, substrate, strain, kh / thickness, thickness=thickness)

    trial = np.linspace(0.05, 1.5, 30)
    rates = np.array([-slowness(kh) for kh in trial])
    best = int(np.argmax(rates))
    if rates[best] == 0:
        raise InputError(
            f"no wrinkle grows at a strain of {strain:.3g}",
            expected="a strain above the critical one",
        )
    bounds = (trial[max(best - 1, 0)], trial[min(best + 1, len(trial) - 1)])
    found = minimize_scalar(slowness, bounds=bounds, method="bounded", options={"xatol": 1e-7})
    return FastestGrowth(rate=-float(found.fun), wavenumber=float(found.x) / thickness)
