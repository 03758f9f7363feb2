"""What a finished measurement shows: the frames with what was detected in them, figures, one page."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.experiments.run_folder import write_text
from wrinklewave.figures import FIGURES, figure_inputs
from wrinklewave.figures.detections import Detection, detections_figure, locking_figure
from wrinklewave.figures.style import PNG
from wrinklewave.imaging.prepared import open_experiment
from wrinklewave.report.page import ReportContext, render

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from wrinklewave.experiments.measure import Measurement
    from wrinklewave.figures.beside import Helper
    from wrinklewave.imaging.calibration import PixelMap
    from wrinklewave.imaging.frames import FrameSource

DETECTIONS_CAPTION = (
    "Frames as they were measured (struck end left, sample below): detected surface (orange), struck end (dashed red), "
    "feet of the probe wires (blue). Where the orange line is missing nothing was detected, or too little to bridge."
)
LOCKING_CAPTION = (
    "Pixel locking: mean difference between the edge found in single columns and the regularised surface, against "
    "where between two rows of pixels that lies, over all frames. Without pixel locking it is zero everywhere."
)


def present_measurement(measurement: Measurement, helper: Helper | None = None) -> Path:
    """Write ``figures/`` and ``report.html`` into the folder of a finished measurement; return the report.

    ``helper`` draws part of the figures beside this process.
    """
    folder, surface, analysis = measurement.folder, measurement.surface, measurement.analysis
    assert folder is not None  # only measurements with a folder are presented
    assert surface is not None  # a finished measurement has one
    assert analysis is not None  # ... and this
    settings = measurement.experiment.analysis
    inputs = figure_inputs(surface, analysis, positions=settings.positions, times=settings.times)
    figures = FIGURES.write(folder / "figures", inputs, kinds={"measurement"}, helper=helper)
    pictures = [
        _saved(folder / "figures" / "detections.png", _detections(measurement), DETECTIONS_CAPTION),
        _saved(
            folder / "figures" / "pixel_locking.png",
            locking_figure(measurement.locking.mean, measurement.locking.mean_sigma),
            LOCKING_CAPTION,
        ),
    ]
    context = ReportContext(
        title=measurement.experiment.name,
        description=measurement.experiment.experiment.description,
        outcome=measurement.outcome.value,
        summary={name: value for name, value in measurement.summary.items() if name != "versions"},
        figures=figures,
        warnings=measurement.warnings,
        case=measurement.experiment.to_toml(),
        versions=measurement.summary["versions"],
        kind="measurement",
    )
    report = folder / "report.html"
    write_text(report, render(context, "measurement.html", pictures=pictures))
    return report


def _saved(path: Path, drawing: Figure, caption: str) -> dict[str, str]:
    """Write a picture, and return it as the templates take it."""
    drawing.savefig(path, dpi=160, **PNG)
    data = base64.b64encode(path.read_bytes()).decode("ascii")
    return {"name": path.stem, "number": "", "caption": caption, "data": data}


def _detections(measurement: Measurement) -> Figure:
    assert measurement.surface is not None  # a finished measurement has one
    assert measurement.pixels is not None  # ... and this
    surface, pixels = measurement.surface, measurement.pixels
    with open_experiment(measurement.experiment) as source:
        return detections_figure(
            [_detection(source, surface, pixels, row) for row in _shown_times(measurement, surface)]
        )


def _shown_times(measurement: Measurement, surface: xr.Dataset) -> list[int]:
    """Times whose frames are shown: at rest, the experiment's own, the largest displacement, the last one."""
    time, u_y = surface["time"].values, surface["u_y"].values
    chosen = [int(np.abs(time - wanted).argmin()) for wanted in measurement.experiment.analysis.times]
    highest = int(np.nan_to_num(np.fmax.reduce(u_y, axis=1)).argmax())
    return sorted({0, *chosen, highest, time.size - 1})


def _detection(source: FrameSource, surface: xr.Dataset, pixels: PixelMap, row: int) -> Detection:
    assert source.times is not None  # impacts have a clock
    here = surface.isel(time=row)
    clock = float(here["time"]) + surface.attrs["contact_on_recording_clock"]
    index = int(np.abs(source.times - clock).argmin())
    return Detection(
        image=source.frame(index),
        caption=f"frame {index}, {_moment(float(here['time']))}",
        surface=np.array(pixels.to_pixels(here["x"].values, here["y"].values)),
        struck_end=float(pixels.to_pixels(here["x_boundary"].values, pixels.height)[0]),
        wires=np.array(pixels.to_pixels(here["x_p"].values, here["y_p"].values)),
    )


def _moment(time: float) -> str:
    """A time [s] on the clock that starts with contact, in words."""
    return f"{1e3 * abs(time):.3g} ms {'before' if time < 0 else 'after'} contact"
