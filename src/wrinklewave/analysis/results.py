"""What an analysis returns: arrays over the surface motion's time and x, SI units, NaN where unknown."""

from __future__ import annotations

from dataclasses import dataclass

from wrinklewave.analysis.boundary import Spectrum
from wrinklewave.analysis.fronts import SpeedFit
from wrinklewave.analysis.wrinkles import WavelengthSpectra
from wrinklewave.laboratory_frame import Array


@dataclass(frozen=True)
class Boundary:
    """Motion of the struck end.

    Attributes:
        displacement: [m], shape [n_times].
        spectrum: of the displacement.
        contact_time, stop_time, separation_time: [s]; NaN where it does not happen or cannot be known.
    """

    displacement: Array
    spectrum: Spectrum
    contact_time: float
    stop_time: float
    separation_time: float


@dataclass(frozen=True)
class Pulse:
    """The low-frequency motion of the surface, wrinkles taken away.

    Attributes:
        height: of the surface [m], shape [n_times, n_x].
        displacement: out of plane [m], shape [n_times, n_x].
        wavefront: where it reaches a fraction of its maximum over the whole map.
        local_wavefront: the same with the maximum at each position.
        arc_strain: mean strain along the curved surface, shape [n_times].
    """

    height: Array
    displacement: Array
    wavefront: SpeedFit
    local_wavefront: SpeedFit
    arc_strain: Array


@dataclass(frozen=True)
class Onset:
    """Where and when wrinkles first reach the threshold, at least one filter wavelength from the struck end.

    Nearer to it the filter cannot tell wrinkles from the curvature of the end.

    Attributes:
        time: [s].
        position: in the laboratory [m].
        distance: from the struck end at that time [m].
    """

    time: float
    position: float
    distance: float


@dataclass(frozen=True)
class Wrinkles:
    """Wrinkles apart from the pulse.

    Attributes:
        height: [m], shape [n_times, n_x].
        envelope: local amplitude [m], same shape.
        amplitude: mean of the envelope over the window [m], shape [n_times].
        spectra: wavelengths in the window.
        front: where the envelope reaches the threshold, in the laboratory.
        material_front: the same at material points, against their undeformed positions.
        onset: the first place of all.
    """

    height: Array
    envelope: Array
    amplitude: Array
    spectra: WavelengthSpectra
    front: SpeedFit
    material_front: SpeedFit
    onset: Onset


@dataclass(frozen=True)
class Strains:
    """Depth-averaged strain and its rate.

    Attributes:
        strain: at material points, shape [n_times, n_points].
        rate: the same [1/s].
        strain_seen, rate_seen: where they are seen in the laboratory, shape [n_times, n_x].
        fast_front: where the rate first becomes noticeable, at material points.
        critical_front: where the strain reaches the film's critical strain, in the laboratory; None without
            film.
        stress_seen: depth-averaged stress [Pa]; None where not known.
        momentary_critical_strain_seen: of the film on a substrate of the momentary modulus; None where not
            known.
    """

    strain: Array
    rate: Array
    strain_seen: Array
    rate_seen: Array
    fast_front: SpeedFit
    critical_front: SpeedFit | None
    stress_seen: Array | None
    momentary_critical_strain_seen: Array | None


@dataclass(frozen=True)
class QuasiStatic:
    """What Eq. 1 expects of a sample strained evenly by the strain along its arc.

    Attributes:
        critical_strain, critical_wavelength: eps_c [1] and lambda_c [m] of the film.
        amplitude, wavelength: against time [m], shape [n_times].
        strain_at_rest: strain when the striker has come to rest, the largest if it never stops.
        amplitude_at_rest: A_0 [m].
        wavelength_at_rest: [m].
    """

    critical_strain: float
    critical_wavelength: float
    amplitude: Array
    wavelength: Array
    strain_at_rest: float
    amplitude_at_rest: float
    wavelength_at_rest: float


@dataclass(frozen=True)
class Analysis:
    """Results of ``analyse``.

    Attributes:
        boundary, pulse, wrinkles: always there.
        strains: None unless the surface motion brings depth-averaged strain along.
        quasi_static: None unless the surface motion names its film.
        summary: scalar results, units in their names; None where there is no number.
    """

    boundary: Boundary
    pulse: Pulse
    wrinkles: Wrinkles
    strains: Strains | None
    quasi_static: QuasiStatic | None
    summary: dict[str, float | None]
