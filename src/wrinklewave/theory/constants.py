"""The constants of a case that the closed forms are made of, by their symbols in the literature."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

from wrinklewave.config.drives import EndMotionDrive, StrikerDrive
from wrinklewave.materials import moduli
from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.theory import film as films
from wrinklewave.theory import viscoelasticity, waves, wrinkling

if TYPE_CHECKING:
    from wrinklewave.config.case import Case
    from wrinklewave.config.solids import Film

Value = TypeVar("Value")


class NotGivenError(LookupError):
    """A case has no such input: no film, no striker, no loss frequency, no relaxation."""


@dataclass(frozen=True)
class Constants:
    """Constants of a case in SI units; :class:`NotGivenError` where the case lacks an input for one.

    The subscript 0 stands for long times, i for instantaneous, 1 for the difference. Young's modulus is taken
    with a constant Poisson's ratio, as the paper does.
    """

    case: Case

    # the block and its material
    @property
    def L(self) -> float:
        """Length of the block [m]."""
        return self.case.block.length

    @property
    def H(self) -> float:
        """Height of the block [m]."""
        return self.case.block.height

    @cached_property
    def solid(self) -> Viscoelastic:
        """The substrate with the bulk response of the case."""
        return moduli.substrate_moduli(self.case.substrate)

    @property
    def rho(self) -> float:
        """Density [kg/m^3]."""
        return self.solid.density

    @property
    def nu(self) -> float:
        """Long-term Poisson's ratio."""
        return moduli.long_term_poisson_ratio(self.case.substrate)

    @property
    def mu_0(self) -> float:
        """Long-term shear modulus [Pa]."""
        return self.solid.mu_inf

    @property
    def mu_i(self) -> float:
        """Instantaneous shear modulus [Pa]."""
        return self.solid.mu_instantaneous

    @property
    def stiffening(self) -> float:
        """Instantaneous over long-term modulus."""
        return self.mu_i / self.mu_0

    @property
    def E_0(self) -> float:
        """Long-term Young's modulus [Pa]."""
        return moduli.youngs_modulus(self.mu_0, self.nu)

    @property
    def E_i(self) -> float:
        """Instantaneous Young's modulus E_0 + E_1 [Pa]."""
        return moduli.youngs_modulus(self.mu_i, self.nu)

    @property
    def K_0(self) -> float:
        """Long-term bulk modulus [Pa]."""
        return moduli.long_term_bulk_modulus(self.case.substrate)

    @property
    def K_i(self) -> float:
        """Instantaneous bulk modulus of a constant Poisson's ratio [Pa]."""
        return self.K_0 * self.stiffening

    @property
    def tau(self) -> float:
        """Shortest relaxation time [s]."""
        return float(self._relaxing.tau_k.min())

    @property
    def retardation_time(self) -> float:
        """Longest creep time [s]."""
        solid = self._relaxing
        return float(viscoelasticity.retardation_times(solid.mu_inf, solid.mu_k, solid.tau_k).max())

    @property
    def _relaxing(self) -> Viscoelastic:
        if not self.solid.tau_k.size:
            raise NotGivenError("prony")
        return self.solid

    # speeds
    @property
    def c_0(self) -> float:
        """Long-term bar speed [m/s]."""
        return waves.bar_speed(self.E_0, self.rho)

    @property
    def c_1(self) -> float:
        """Instantaneous bar speed [m/s]."""
        return waves.bar_speed(self.E_i, self.rho)

    @property
    def plate_0(self) -> float:
        """Long-term speed in plane strain [m/s]."""
        return waves.plate_speed(self.E_0, self.nu, self.rho)

    @property
    def plate_1(self) -> float:
        """Instantaneous speed in plane strain [m/s]."""
        return waves.plate_speed(self.E_i, self.nu, self.rho)

    # a sine wave
    @property
    def omega(self) -> float:
        """Angular frequency of ``analysis.loss_frequency`` [rad/s]."""
        return 2 * math.pi * _given(self.case.analysis.loss_frequency)

    @cached_property
    def E_star(self) -> complex:
        """Complex Young's modulus at ``omega`` [Pa]."""
        E_k = moduli.youngs_modulus(1.0, self.nu) * self.solid.mu_k
        return complex(viscoelasticity.complex_modulus(self.omega, self.E_0, E_k, self.solid.tau_k))

    @property
    def c_star(self) -> float:
        """Phase speed of a bar wave at ``omega`` [m/s]."""
        return waves.viscoelastic_bar_speed(self.E_star, self.rho)

    # the impact
    @property
    def V_S(self) -> float:
        """Speed of the striker, or of the end [m/s]."""
        return self._drive.velocity

    @property
    def travel(self) -> float:
        """Distance l to the stoppers [m]."""
        return self._drive.stop_distance

    @property
    def c(self) -> float:
        """Measured speed of the wavefront [m/s]."""
        return _given(self.case.analysis.measured_front_speed)

    @property
    def _drive(self) -> StrikerDrive | EndMotionDrive:
        if not isinstance(self.case.drive, StrikerDrive | EndMotionDrive):
            raise NotGivenError("drive")
        return self.case.drive

    # the film
    @property
    def film(self) -> Film:
        """The film's section of the case."""
        return _given(self.case.film)

    @property
    def h(self) -> float:
        """Thickness of the film [m]."""
        return self.film.thickness

    @property
    def eps_c(self) -> float:
        """Measured critical strain."""
        return _given(self.film.critical_strain)

    @property
    def lambda_c(self) -> float:
        """Measured critical wavelength [m]."""
        return _given(self.film.critical_wavelength)

    @cached_property
    def E_s(self) -> float:
        """Long-term plane-strain modulus of the substrate [Pa]."""
        return films.substrate_plane_strain_modulus(self.case.substrate)

    @cached_property
    def E_f(self) -> float:
        """Plane-strain modulus of the film [Pa]; from the critical strain where the case does not say."""
        film = self.film
        if film.shear_modulus is None and film.modulus_from is None:
            return self.E_s * wrinkling.modulus_ratio_of_strain(self.eps_c)
        return films.film_plane_strain_modulus(film, self.case.substrate)


def _given(value: Value | None) -> Value:
    if value is None:
        raise NotGivenError
    return value
