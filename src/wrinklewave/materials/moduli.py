"""Small-strain moduli: relations between them, and the relaxing moduli of a substrate or a film.

Isotropic solids; mu is the shear modulus, K the bulk modulus, E Young's modulus, nu Poisson's ratio. The
subscript ``inf`` stands for long times (the paper's mu_0), ``k`` for the Prony terms, "instantaneous" for the
sum of all.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from wrinklewave.config.solids import BulkResponse, Film, PronyTerm, Substrate


def youngs_modulus(mu: float, nu: float) -> float:
    """E = 2 mu (1 + nu) [Pa]."""
    return 2 * mu * (1 + nu)


def shear_modulus(E: float, nu: float) -> float:
    """Return mu = E / (2 (1 + nu)) [Pa]."""
    return E / (2 * (1 + nu))


def bulk_modulus(mu: float, nu: float) -> float:
    """K = 2 mu (1 + nu) / (3 (1 - 2 nu)) = E / (3 (1 - 2 nu)) [Pa]."""
    return 2 * mu * (1 + nu) / (3 * (1 - 2 * nu))


def poisson_ratio(mu: float, K: float) -> float:
    """Return nu = (3 K - 2 mu) / (2 (3 K + mu))."""
    return (3 * K - 2 * mu) / (2 * (3 * K + mu))


def plane_strain_modulus(E: float, nu: float) -> float:
    """Return E / (1 - nu^2) [Pa], the modulus of a thin plate that cannot contract across its width."""
    return E / (1 - nu**2)


def plane_wave_modulus(mu: float, K: float) -> float:
    """M = K + 4 mu / 3 [Pa], the modulus of one-dimensional strain."""
    return K + 4 * mu / 3


@dataclass(frozen=True, eq=False)
class Viscoelastic:
    """An isotropic solid whose moduli relax: mu(t) = mu_inf + sum_k mu_k exp(-t/tau_k), and likewise K(t).

    Args:
        density: mass density before deformation [kg/m^3].
        mu_inf: long-term shear modulus [Pa].
        K_inf: long-term bulk modulus [Pa].
        mu_k: shear shares of the Prony terms [Pa], shape [n_terms].
        K_k: bulk shares of the Prony terms [Pa], shape [n_terms].
        tau_k: relaxation times [s], shape [n_terms].
    """

    density: float
    mu_inf: float
    K_inf: float
    mu_k: NDArray[np.float64]
    K_k: NDArray[np.float64]
    tau_k: NDArray[np.float64]

    @property
    def mu_instantaneous(self) -> float:
        """Shear modulus at once after a step [Pa]."""
        return self.mu_inf + float(self.mu_k.sum())

    @property
    def K_instantaneous(self) -> float:
        """Bulk modulus at once after a step [Pa]."""
        return self.K_inf + float(self.K_k.sum())

    @property
    def nu_inf(self) -> float:
        """Long-term Poisson's ratio."""
        return poisson_ratio(self.mu_inf, self.K_inf)

    @property
    def nu_instantaneous(self) -> float:
        """Poisson's ratio at once after a step; beyond -1 to 0.5 for no positive moduli."""
        return poisson_ratio(self.mu_instantaneous, self.K_instantaneous)

    def mu(self, t: ArrayLike) -> NDArray[np.float64]:
        """Shear relaxation modulus [Pa] at times ``t`` >= 0 [s], of the shape of ``t``."""
        return _relaxing(self.mu_inf, self.mu_k, self.tau_k, t)

    def K(self, t: ArrayLike) -> NDArray[np.float64]:
        """Bulk relaxation modulus [Pa] at times ``t`` >= 0 [s], of the shape of ``t``."""
        return _relaxing(self.K_inf, self.K_k, self.tau_k, t)


def viscoelastic(
    *,
    density: float,
    shear_modulus: float,
    bulk_modulus_0: float,
    bulk_response: BulkResponse,
    prony: Sequence[PronyTerm],
) -> Viscoelastic:
    """Return the relaxing moduli under one of the choices of bulk response.

    - ``"elastic-long-term"``: K = K_0 at all times.
    - ``"elastic-instantaneous"``: K = K_i at all times, K_i = K_0 mu_i/mu_0 = (E_0 + E_1)/(3 (1 - 2 nu)).
    - ``"relaxing"``: K relaxes from K_i to K_0 in proportion to the shear modulus, so that nu stays constant.
    - ``"custom"``: each term has a bulk share of its own.

    Args:
        density: [kg/m^3].
        shear_modulus: long-term mu_0 [Pa].
        bulk_modulus_0: long-term K_0 [Pa].
        bulk_response: the choice.
        prony: the terms, with ``bulk_modulus`` set if the choice is ``"custom"``.
    """
    mu_k = np.array([term.shear_modulus for term in prony], dtype=np.float64)
    K_inf, K_k = bulk_modulus_0, np.zeros_like(mu_k)
    if bulk_response == "elastic-instantaneous":
        K_inf *= 1 + float(mu_k.sum()) / shear_modulus
    elif bulk_response == "relaxing":
        K_k = K_inf * mu_k / shear_modulus
    elif bulk_response == "custom":
        K_k = np.array([term.bulk_modulus for term in prony], dtype=np.float64)
    tau_k = np.array([term.relaxation_time for term in prony], dtype=np.float64)
    return Viscoelastic(density=density, mu_inf=shear_modulus, K_inf=K_inf, mu_k=mu_k, K_k=K_k, tau_k=tau_k)


def long_term_bulk_modulus(substrate: Substrate) -> float:
    """K_0 [Pa] of a case's substrate, as given or from Poisson's ratio."""
    if substrate.bulk_modulus is not None:
        return substrate.bulk_modulus
    assert substrate.poisson_ratio is not None  # a case has one of the two
    return bulk_modulus(substrate.shear_modulus, substrate.poisson_ratio)


def long_term_poisson_ratio(substrate: Substrate) -> float:
    """Return nu of a case's substrate, as given or from the long-term bulk modulus."""
    if substrate.poisson_ratio is not None:
        return substrate.poisson_ratio
    return poisson_ratio(substrate.shear_modulus, long_term_bulk_modulus(substrate))


def substrate_moduli(substrate: Substrate) -> Viscoelastic:
    """Return the relaxing moduli of a case's substrate."""
    return viscoelastic(
        density=substrate.density,
        shear_modulus=substrate.shear_modulus,
        bulk_modulus_0=long_term_bulk_modulus(substrate),
        bulk_response=substrate.bulk_response,
        prony=substrate.prony,
    )


def film_moduli(film: Film, mu: float) -> Viscoelastic:
    """Return the relaxing moduli of a case's film, given its long-term shear modulus ``mu`` [Pa].

    The modulus is an argument because it may have to be derived from measured wrinkles, see
    :func:`wrinklewave.theory.film.film_shear_modulus`.
    """
    return viscoelastic(
        density=film.density,
        shear_modulus=mu,
        bulk_modulus_0=bulk_modulus(mu, film.poisson_ratio),
        bulk_response=film.bulk_response,
        prony=film.prony,
    )


def _relaxing(
    long_term: float, shares: NDArray[np.float64], tau: NDArray[np.float64], t: ArrayLike
) -> NDArray[np.float64]:
    decays = np.exp(-np.asarray(t, dtype=np.float64)[..., np.newaxis] / tau)
    return long_term + decays @ shares
