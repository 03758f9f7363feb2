"""Errors of everything that is measured in an impact, over a grid of recordings of which every number is known.

    python -m benchmarks.measuring_grid [DOCS]

films analytic travelling pulses with wrinkles on them, one thing changed at a time, measures each recording, writes
``tables/measuring_grid.md`` and ``images/measuring_grid.png`` into DOCS, by default ``docs``; takes some two minutes.
"""

from __future__ import annotations

import argparse
import math
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

import wrinklewave as ww
from benchmarks.synthetic_edges import Array, rms
from wrinklewave.config.recorded import recorded_analysis
from wrinklewave.wrinkling.travelling_pulse import TravellingPulse

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ROOT = Path(__file__).parents[1]
PULSE = TravellingPulse(end_time=2.6e-3, interval=20e-6)
FRAMES_BEFORE = 20
MARGIN = 12
LEVEL = 1e-3  # rad: of a tilted sample, columns of the image are no places on it
CASE = ("drive.rise_time=0.001 us",)


@dataclass(frozen=True)
class Recording:
    """A film to be measured.

    Attributes:
        pulse: what is filmed.
        contrast_to_noise: of even noise; None for a sensor's shot and read noise.
        camera: attributes of the camera.
        seed: of the noise.
        wires: undeformed positions [m]; None for the usual three.
    """

    pulse: TravellingPulse = PULSE
    contrast_to_noise: float | None = 20.0
    camera: dict[str, Any] = field(default_factory=lambda: {"blur": 1.2, "frame_rate": 50e3})
    seed: int = 0
    wires: tuple[float, ...] | None = None

    def with_camera(self, **changes: Any) -> Recording:
        """The same film by another camera."""
        return replace(self, camera=self.camera | changes)

    def with_pulse(self, **changes: float) -> Recording:
        """Another pulse by the same camera."""
        return replace(self, pulse=replace(self.pulse, **changes))


USUAL = Recording()
GRID: dict[str, dict[float, Recording]] = {
    "contrast over noise": {r: replace(USUAL, contrast_to_noise=r) for r in (5.0, 10.0, 20.0, 50.0, 100.0)},
    "blur (px)": {b: USUAL.with_camera(blur=b) for b in (0.5, 1.2, 2.0, 3.0)},
    "wavelength (mm)": {w: USUAL.with_pulse(wavelength=1e-3 * w) for w in (1.0, 1.5, 2.0, 3.0)},
    "amplitude (µm)": {a: USUAL.with_pulse(amplitude=1e-6 * a) for a in (40.0, 80.0, 150.0, 250.0)},
    "frame rate (kHz)": {
        r: USUAL.with_camera(frame_rate=1e3 * r).with_pulse(interval=1e-3 / r) for r in (20.0, 50.0, 100.0)
    },
}
OTHERS = {
    "shot and read noise, 12 bit": replace(USUAL, contrast_to_noise=None),
    "shot and read noise, 8 bit": replace(USUAL, contrast_to_noise=None).with_camera(
        bit_depth=8, black_level=4
    ),
    "tilted by 1°": USUAL.with_camera(tilt=math.radians(1.0)),
    "tilted by 2°": USUAL.with_camera(tilt=math.radians(2.0)),
    "a lamp that falls off by a third": USUAL.with_camera(gradient=(-0.33, 0.1)),
}


@dataclass(frozen=True)
class Quantity:
    """What is measured: its name and unit, what the error may be, and whether that is a share of the true value."""

    name: str
    limit: float
    share: bool

    def shown(self, error: float) -> str:
        """An error in its unit, marked where it is above the limit."""
        if not np.isfinite(error):
            return "–"
        text = f"{100 * error:.2f}" if self.share else f"{error:.3f}" if self.limit < 1 else f"{error:.1f}"
        return text if abs(error) <= self.limit else f"**{text}**"


QUANTITIES = {
    "edge": Quantity("surface (px)", 0.06, False),
    "amplitude": Quantity("amplitude (px)", 0.02, False),
    "amplitude_share": Quantity("amplitude (%)", 0.02, True),
    "wavelength": Quantity("wavelength (%)", 0.005, True),
    "wave_speed": Quantity("wave speed (%)", 0.01, True),
    "wrinkle_speed": Quantity("wrinkle speed (%)", 0.03, True),
    "struck_end": Quantity("struck end (px)", 0.05, False),
    "wires": Quantity("wires (px)", 0.05, False),
    "contact": Quantity("contact (µs)", 20.0, False),
}
"""The limits are those aimed at for 20 px/mm and a contrast over noise of 20, for the amplitude either of the two; for
the moment of contact a frame at 50 kHz."""


def main() -> None:
    """Measure everything; write table and picture."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("docs", type=Path, nargs="?", default=ROOT / "docs")
    docs = parser.parse_args().docs
    done: dict[str, dict[str, float]] = {}

    def errors(recording: Recording) -> dict[str, float]:
        key = repr(recording)
        if key not in done:
            done[key] = errors_of(recording)
            print({name: round(value, 4) for name, value in done[key].items()}, flush=True)
        return done[key]

    grid = {what: {at: errors(one) for at, one in line.items()} for what, line in GRID.items()}
    others = {what: errors(one) for what, one in OTHERS.items()}
    text = "\n".join(table(grid, others)) + "\n"
    print(text)
    (docs / "tables" / "measuring_grid.md").write_text(text, encoding="utf-8")
    curves(grid).savefig(docs / "images" / "measuring_grid.png")


def errors_of(recording: Recording) -> dict[str, float]:
    """Film, measure, and hold the measurement against what was filmed."""
    with tempfile.TemporaryDirectory() as folder:
        run = Path(folder)
        surface = recording.pulse.surface()
        ww.write_surface(surface, run / "surface.nc")
        case = ww.load_case(ROOT / "examples" / "paper_impact.toml", CASE)
        (run / "case.toml").write_text(case.to_toml(), encoding="utf-8")
        film = ww.film_run(
            run,
            run / "film.tif",
            contrast_to_noise=recording.contrast_to_noise,
            seed=recording.seed,
            wires=recording.wires,
            **recording.camera,
        )
        found = ww.measure(film.experiment, threads=1)
        truth = xr.load_dataset(film.truth, engine="h5netcdf")
    assert found.surface is not None
    return frame_errors(found.surface, truth) | analysis_errors(found.surface, surface, truth["time"].values)


def frame_errors(measured: xr.Dataset, truth: xr.Dataset) -> dict[str, float]:
    """Root mean square errors over all frames of what is found in each [px].

    The surface's is that of its displacement, ``MARGIN`` columns and more from wires and ends: nearer, it is bridged.
    """
    pixel = float(truth.attrs["pixel_size"])
    assert truth.sizes["frame"] == measured.sizes["time"]
    tilt = float(measured.attrs["tilt"])
    end = truth["boundary_column"].values
    wires = truth["wire_column"].values if "wire_column" in truth else np.empty((end.size, 0))
    end_row = truth["boundary_row"].values
    wire_rows = truth["wire_row"].values if "wire_row" in truth else wires

    def along(columns: Array, at_rows: Array) -> Array:
        """Distance from the struck end at rest along the undeformed surface [px]."""
        return (columns - end[0]) * math.cos(tilt) + (end_row[0] - at_rows) * math.sin(tilt)

    at_end = measured["x_boundary"].values / pixel - along(end, end_row)
    at_wires = measured["x_p"].values / pixel - along(wires, wire_rows)
    columns = np.rint(measured.attrs["origin_column"] + measured["x"].values / pixel).astype(int)
    rows = truth["edge_row"].values
    off = measured["u_y"].values / pixel - (rows[:1] - rows)[:, columns]
    near = (np.abs(columns[None, :, None] - wires[:, None, :]) < MARGIN).any(axis=2)
    near |= (columns < end[:, None] + MARGIN) | (columns > np.flatnonzero(np.isfinite(rows[0]))[-1] - MARGIN)
    level = abs(tilt) < LEVEL
    return {
        "edge": rms(np.where(near, np.nan, off)) if level else math.nan,
        "struck_end": rms(at_end),
        "wires": rms(at_wires) if at_wires.size else math.nan,
    }


def analysis_errors(measured: xr.Dataset, true: xr.Dataset, film_times: Array) -> dict[str, float]:
    """Errors of amplitude and wavelength at all times with wrinkles, and of the speeds, by the same analysis."""
    settings = recorded_analysis([measured.attrs])
    found, expected = ww.analyse(measured, settings), ww.analyse(true, settings)
    late = measured.attrs["contact_on_recording_clock"] - float(film_times[FRAMES_BEFORE] - film_times[0])
    clock = (
        measured["time"].values + late
    )  # the true one: an error of the moment of contact is told by itself
    at = np.interp(true["time"].values, clock, np.arange(clock.size))

    def seen(values: Array) -> Array:
        return np.interp(at, np.arange(values.size), values)

    amplitude = expected.wrinkles.amplitude
    formed = amplitude >= 0.9 * np.nanmax(amplitude)
    off = (seen(found.wrinkles.amplitude) - amplitude)[formed]
    wavelength = (seen(found.wrinkles.spectra.peak) / expected.wrinkles.spectra.peak - 1.0)[formed]
    return {
        "contact": 1e6 * late,
        "amplitude": rms(off) / 50e-6,
        "amplitude_share": rms(off / amplitude[formed]),
        "wavelength": rms(wavelength),
        "wave_speed": found.pulse.wavefront.speed / expected.pulse.wavefront.speed - 1.0,
        "wrinkle_speed": found.wrinkles.front.speed / expected.wrinkles.front.speed - 1.0,
    }


def table(
    grid: dict[str, dict[float, dict[str, float]]], others: dict[str, dict[str, float]]
) -> Iterator[str]:
    """A line for each recording; errors above their limit are set in bold."""
    yield f"| recording | {' | '.join(quantity.name for quantity in QUANTITIES.values())} |"
    yield f"| --- |{' --- |' * len(QUANTITIES)}"
    limits = (f"{100 * q.limit:g}" if q.share else f"{q.limit:g}" for q in QUANTITIES.values())
    yield f"| *limit* | {' | '.join(limits)} |"
    lines = {f"{what} {at:g}": errors for what, line in grid.items() for at, errors in line.items()}
    for what, errors in (lines | others).items():
        cells = (quantity.shown(errors[name]) for name, quantity in QUANTITIES.items())
        yield f"| {what} | {' | '.join(cells)} |"


def curves(grid: dict[str, dict[float, dict[str, float]]]) -> Figure:
    """Errors against what is changed: a row of panels for each quantity, a column for each thing changed."""
    import matplotlib

    from wrinklewave.figures.style import RC, Margins, new_figure

    margins = Margins(left=0.75, right=0.1, top=0.1, between_columns=0.15, between_rows=0.12)
    with matplotlib.rc_context(RC | {"font.size": 8}):
        drawing, axes = new_figure(
            9.0, 10.0, rows=len(QUANTITIES), columns=len(grid), margins=margins, sharex="col", sharey="row"
        )
        for row, (name, quantity) in zip(axes, QUANTITIES.items(), strict=True):
            factor = 100.0 if quantity.share else 1.0
            for panel, line in zip(row, grid.values(), strict=True):
                values = [factor * abs(errors[name]) for errors in line.values()]
                panel.plot(list(line), values, "o-", ms=3.5, lw=0.9, color="black")
                panel.axhline(factor * quantity.limit, color="#c1272d", lw=0.8, ls="--")
                panel.set_yscale("log")
            row[0].set_ylabel(quantity.name)
        for panel, what in zip(axes[-1], grid, strict=True):
            panel.set_xlabel(what)
        for what, column in zip(grid, axes.T, strict=True):
            if what == "contrast over noise":
                column[0].set_xscale("log")
    return drawing


if __name__ == "__main__":
    main()
