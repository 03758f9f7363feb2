"""Simulate, film, measure, compare: what the measurement finds of a simulated impact whose truth is known.

    python benchmarks/measuring_chain.py [CASE] [--folder DIR] [--table FILE]

Every step is a command as a user would type it. A step whose results lie in DIR already is not done again. The
table holds each measured quantity against the simulation's own, or against the truth that the camera wrote.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

import wrinklewave as ww
from wrinklewave.config.recorded import recorded_analysis
from wrinklewave.experiments.compare import compare
from wrinklewave.experiments.impact_moments import EndTrack, find_moments

CONTRAST_TO_NOISE, PIXELS_PER_MM = 20, 20


class Line(NamedTuple):
    """A quantity, its true and its measured value, the error and what is allowed, in words."""

    quantity: str
    true: str
    measured: str
    error: str
    allowed: str
    kept: bool


def main() -> int:
    """Run the chain, print and write the table; 1 if an error is larger than allowed."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("case", nargs="?", type=Path, default=Path("examples/paper_impact.toml"))
    parser.add_argument("--folder", type=Path, default=Path("runs/measuring-chain"))
    parser.add_argument("--table", type=Path, default=Path("docs/tables/measuring_chain.md"))
    arguments = parser.parse_args()
    run, measured, video = (arguments.folder / name for name in ("run", "measured", "film/impact.tif"))
    video.parent.mkdir(parents=True, exist_ok=True)
    experiment, truth = video.with_suffix(".experiment.toml"), video.with_suffix(".truth.nc")
    step(run / "surface.nc", "simulate", arguments.case, "--out", run)
    camera = ("--scale", PIXELS_PER_MM, "--contrast-to-noise", CONTRAST_TO_NOISE)
    step(experiment, "film", run, "--out", video, *camera)
    step(measured / "surface.nc", "measure", experiment, "--out", measured)
    tracks = np.genfromtxt(measured / "tracks.csv", delimiter=",", names=True)
    true = xr.load_dataset(truth, engine="h5netcdf")
    summary = json.loads((measured / "summary.json").read_text(encoding="utf-8"))
    lines = table_lines(ww.read_surface(run), ww.read_surface(measured), true, tracks)
    lines += moment_lines(true, summary)
    text = as_markdown(lines, arguments.case)
    print(text)
    arguments.table.write_text(text, encoding="utf-8")
    return int(not all(line.kept for line in lines))


def step(result: Path, *command: object) -> None:
    """Run a command of wrinklewave unless its result is there."""
    if not result.exists():
        subprocess.run([sys.executable, "-m", "wrinklewave", *map(str, command)], check=True)


def table_lines(
    simulated: xr.Dataset, measured: xr.Dataset, truth: xr.Dataset, tracks: np.ndarray
) -> list[Line]:
    """Errors of everything that is measured."""
    found = compare(
        {"simulated": simulated, "measured": measured}, recorded_analysis([simulated.attrs, measured.attrs])
    )
    values = {quantity.name: quantity.values for quantity in found.quantities}
    agreement = found.agreements["measured"]
    pixel = float(truth.attrs["pixel_size"])
    origin = truth["boundary_column"].values[0]
    boundary = (truth["boundary_column"].values - origin) * pixel
    wires = (truth["wire_column"].values - origin) * pixel
    striker = (truth["striker_column"].values - origin) * pixel
    return [
        relative("wave speed (m/s)", *values["wavefront_speed_m_per_s"], 0.01),
        relative(
            "wave speed, line through the origin (m/s)", *values["wavefront_speed_origin_line_m_per_s"], 0.01
        ),
        relative("wrinkle speed (m/s)", *values["wrinkle_speed_m_per_s"], 0.03),
        relative(
            "wrinkle amplitude over the simulation's, mean over time", 1.0, agreement.amplitude.mean, 0.02
        ),
        relative("wavelength over the simulation's, mean over time", 1.0, agreement.wavelength.mean, 0.005),
        in_pixels("struck end, all frames", measured["x_boundary"].values, boundary, pixel),
        in_pixels("striker, all frames", tracks["x_striker_m"], striker, pixel),
        in_pixels("wires, all frames", measured["x_p"].values, wires, pixel),
    ]


def moment_lines(truth: xr.Dataset, summary: dict[str, Any]) -> list[Line]:
    """Moments of the impact against those of the true gap, continued to zero between frames in the same way."""
    time = truth["time"].values - truth["time"].values[0]
    end, striker = truth["boundary_column"].values, truth["striker_column"].values
    nothing, touching = np.full(time.size, 1e-3), (end - striker < 1e-3).astype(float)
    track = EndTrack(
        time,
        end,
        nothing,
        truth["boundary_row"].values,
        nothing,
        striker,
        nothing,
        end - striker,
        nothing,
        touching,
        end[0],
    )
    true = find_moments(track)
    contact = summary["contact_on_recording_clock_s"]
    lines = [in_microseconds("contact", true.contact.time, contact)]
    for name, moment in (("separation", true.separation), ("recontact", true.recontact)):
        lines.append(in_microseconds(name, moment.time, contact + summary[f"striker_{name}_time_s"]))
    return lines


def in_microseconds(moment: str, true: float, measured: float, allowed: float = 10.0) -> Line:
    """A line for a moment on the recording's clock [s]; frames are 20 microseconds apart."""
    error = 1e6 * (measured - true)
    return Line(
        f"moment of {moment} (µs)",
        f"{1e6 * true:.1f}",
        f"{1e6 * measured:.1f}",
        f"{error:+.1f} µs",
        f"{allowed:g} µs",
        abs(error) <= allowed,
    )


def relative(quantity: str, true: float, measured: float, allowed: float) -> Line:
    """A line of which the error is a share of the true value."""
    error = measured / true - 1.0
    return Line(
        quantity, f"{true:.4g}", f"{measured:.4g}", f"{error:+.2%}", f"{allowed:.1%}", abs(error) <= allowed
    )


def in_pixels(
    quantity: str, measured: np.ndarray, true: np.ndarray, pixel: float, allowed: float = 0.05
) -> Line:
    """A line of which the error is a root mean square over frames in pixels; frames without a number are counted."""
    error = (measured - true) / pixel
    known = np.isfinite(error)
    rms = float(np.sqrt(np.mean(error[known] ** 2)))
    share = f"seen in {known.sum() / np.isfinite(true).sum():.1%}"
    return Line(quantity, "", share, f"{rms:.3f} px", f"{allowed} px", rms <= allowed)


def as_markdown(lines: list[Line], case: Path) -> str:
    """The table, with how it came about."""
    rows = [
        f"| {line.quantity} | {line.true} | {line.measured} | {line.error} | {line.allowed} |"
        for line in lines
    ]
    return "\n".join(
        [
            f"`{case.name}`, filmed at {PIXELS_PER_MM} px/mm with a contrast-to-noise ratio of {CONTRAST_TO_NOISE}:",
            "",
            "| quantity | simulation | measurement | error | allowed |",
            "| --- | --- | --- | --- | --- |",
            *rows,
            "",
        ]
    )


if __name__ == "__main__":
    sys.exit(main())
