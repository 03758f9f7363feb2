"""What a measurement says about itself: attributes of its surface motion, scalar results, warnings."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from wrinklewave._version import __version__
from wrinklewave.environment import versions

if TYPE_CHECKING:
    import xarray as xr

    from wrinklewave.analysis.results import Analysis
    from wrinklewave.config.experiment import Experiment
    from wrinklewave.experiments.impact_moments import EndTrack, Impact
    from wrinklewave.experiments.measured_surface import FrameSeries
    from wrinklewave.imaging.appearance import Appearance
    from wrinklewave.imaging.calibration import PixelMap
    from wrinklewave.imaging.frames import FrameSource
    from wrinklewave.imaging.tracks import WireTracks

LOCKED = 0.02
"""Pixels of pixel locking that are worth a warning."""
OFTEN_LOST = 0.05
"""Share of frames without the struck end that is worth a warning."""
FAINT = 5.0
"""Contrast-to-noise ratio below which edges are lost."""
NAMED_FRAMES = 5
SCALE_TOLERANCE = 0.005
"""Relative difference between the length that is seen and the one that is given that nobody should overlook."""


def surface_attributes(
    experiment: Experiment, appearance: Appearance, pixels: PixelMap, impact: Impact | None = None
) -> dict[str, Any]:
    """Attributes of a measured surface motion; those that are not known are left out."""
    sample = experiment.sample
    distance = impact.stop_distance * pixels.pixel_size if impact else np.nan
    attributes = {
        "kind": "measurement",
        "name": experiment.name,
        "length": sample.length,
        "height": sample.height,
        "critical_strain": sample.critical_strain,
        "critical_wavelength": sample.critical_wavelength,
        "stop_distance": distance if np.isfinite(distance) else None,
        "contact_on_recording_clock": impact.contact.time if impact else None,
        "pixel_size": pixels.pixel_size,
        "origin_column": pixels.origin[0],
        "origin_row": pixels.origin[1],
        "tilt": pixels.tilt,
        "blur_px": appearance.optics.blur,
        "wrinklewave_version": __version__,
        "experiment": experiment.to_toml(),
    }
    return {name: value for name, value in attributes.items() if value is not None}


def measurement_summary(
    source: FrameSource,
    appearance: Appearance,
    pixels: PixelMap,
    series: FrameSeries,
    track: EndTrack,
    impact: Impact,
    tracks: WireTracks | None,
    surface: xr.Dataset,
    analysis: Analysis,
) -> tuple[dict[str, Any], list[str]]:
    """Scalar results with units in their names, the analysis' own among them, and warnings."""
    pixel = pixels.pixel_size
    locking = series.locking.amplitude
    values: dict[str, float] = {
        "contact_on_recording_clock_s": impact.contact.time,
        "contact_sigma_s": impact.contact.sigma,
        "striker_stop_time_s": impact.stop.time - impact.contact.time,
        "striker_stop_sigma_s": impact.stop.sigma,
        "striker_separation_time_s": impact.separation.time - impact.contact.time,
        "striker_separation_sigma_s": impact.separation.sigma,
        "striker_recontact_time_s": impact.recontact.time - impact.contact.time,
        "striker_recontact_sigma_s": impact.recontact.sigma,
        "striker_stop_distance_m": impact.stop_distance * pixel,
        "striker_velocity_m_per_s": _velocity(track, impact) * pixel,
        "pixel_size_m": pixel,
        "tilt_rad": pixels.tilt,
        "blur_px": appearance.optics.blur,
        "contrast_to_noise": float(np.median(series.contrast / series.noise)),
        "surface_sigma_px": float(np.nanmedian(surface["u_y_sigma"].values)) / pixel,
        "struck_end_sigma_px": _median(track.sigma),
        "striker_sigma_px": _median(track.striker_sigma),
        "wire_sigma_px": _median(tracks.sigma) if tracks else float("nan"),
        "pixel_locking_px": locking,
        "surface_seen_share": float(np.median(series.seen)),
        "struck_end_seen_share": float(np.isfinite(track.column).mean()),
    }
    summary: dict[str, Any] = {
        "name": surface.attrs["name"],
        "outcome": "finished",
        "message": "finished",
        **analysis.summary,
        **{name: float(value) if np.isfinite(value) else None for name, value in values.items()},
        "frames": source.n_frames,
        "frames_measured": int(series.frame.size),
        "unreadable_frames": [list(pair) for pair in source.unreadable],
        "wires": 0 if tracks is None else tracks.column.shape[1],
        "wire_gaps": [] if tracks is None else [vars(gap) for gap in tracks.gaps],
        "frames_analysed": surface.sizes["time"],
        "versions": versions(),
    }
    warnings = [
        *source.notes,
        *_struck_too_early(track),
        *_unreadable(source),
        *_poor_edges(summary),
        *_end_out_of_sight(appearance, summary),
        *_lost_wires(tracks),
        *_not_analysed(summary),
    ]
    return summary, warnings


def _struck_too_early(track: EndTrack) -> Iterator[str]:
    if track.touching[0] == 1.0:
        yield (
            "The striker touches in the first frame already: contact is taken to be when the struck end begins to "
            "move. If it was struck before, the sample was not at rest: begin earlier (video.frames)."
        )


def _unreadable(source: FrameSource) -> Iterator[str]:
    if source.unreadable:
        named = "; ".join(f"{index}: {why}" for index, why in source.unreadable[:NAMED_FRAMES])
        more = len(source.unreadable) - NAMED_FRAMES
        yield (
            f"{len(source.unreadable)} of {source.n_frames} frames cannot be read and are left out "
            f"({named}{f'; and {more} more' if more > 0 else ''})."
        )


def _poor_edges(summary: dict[str, Any]) -> Iterator[str]:
    locking, ratio = summary["pixel_locking_px"], summary["contrast_to_noise"]
    if locking is not None and locking > LOCKED:
        yield (
            f"Pixel locking of {locking:.3f} px: the profile of the edge is not that of a blurred step "
            "(too sharp for the pixels, compressed, or sharpened by the camera)."
        )
    if ratio < FAINT:
        yield f"The contrast at the surface is only {ratio:.1f} times the noise."


def _end_out_of_sight(appearance: Appearance, summary: dict[str, Any]) -> Iterator[str]:
    if summary["struck_end_seen_share"] < 1.0 - OFTEN_LOST:
        yield (
            f"The struck end is seen in {summary['struck_end_seen_share']:.0%} of the frames only: it must be in "
            "sight, and a striker as bright as the sample must be higher or lower than it."
        )
    if appearance.striker_alike:
        yield (
            "The striker is as bright as the sample: while they touch, the end is where their upper edges meet in a "
            "step, and unknown where these are level. Paint the striker, or light it otherwise."
        )


def _lost_wires(tracks: WireTracks | None) -> Iterator[str]:
    lost = [] if tracks is None else [gap for gap in tracks.gaps if not gap.bridged]
    if lost:
        named = ", ".join(
            f"wire {gap.wire} in frames {gap.first} to {gap.stop - 1}" for gap in lost[:NAMED_FRAMES]
        )
        yield f"Wires are lost for longer than is bridged: {named}."


def _not_analysed(summary: dict[str, Any]) -> Iterator[str]:
    if summary["frames_analysed"] < summary["frames_measured"]:
        yield (
            f"Of {summary['frames_measured']} frames, {summary['frames_analysed']} from contact on are analysed; "
            "surface.nc holds all."
        )


def scale_warnings(
    experiment: Experiment, appearance: Appearance, pixels: PixelMap, rest: float
) -> Iterator[str]:
    """Whether the sample at rest, struck end in the column ``rest``, is as long in the images as it is said to be."""
    seen = pixels.pixel_size * (appearance.held_end - rest) / np.cos(pixels.tilt)
    off = seen / experiment.sample.length - 1.0
    if np.isfinite(off) and abs(off) > SCALE_TOLERANCE:
        yield (
            f"{experiment.video.file.name}: in the undeformed images the sample is {1e3 * seen:.4g} mm long, not "
            f"{1e3 * experiment.sample.length:.4g} mm ({off:+.1%}). Strains and lengths are off by as much if the "
            'scale is wrong: calibration.kind = "sample-length" takes it from the sample.'
        )


def _velocity(track: EndTrack, impact: Impact) -> float:
    """Speed of the striker in its last frames before contact [px/s]."""
    known = np.flatnonzero(np.isfinite(track.striker) & (track.time < impact.contact.time))[-10:]
    if known.size < 3:
        return float("nan")
    return float(np.polyfit(track.time[known], track.striker[known], 1)[0])


def _median(values: Any) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else float("nan")
