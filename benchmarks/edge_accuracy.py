"""Errors of the edge detector against the Cramér-Rao bounds, and beside what a user would do without it.

    python -m benchmarks.edge_accuracy [DOCS]

writes ``images/edge_errors.png``, ``tables/edge_limits.md`` and ``tables/edge_methods.md`` into DOCS, by default
``docs``. Takes two minutes. The methods of scikit-image are held beside it where that is installed
(``pip install "wrinklewave[benchmarks]"``).
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.synthetic_edges import Array, band_limited, edge_image, rms, tilted, with_noise, wrinkled
from wrinklewave.imaging.edges import RESOLUTION, Edge, EdgeFinder, Optics
from wrinklewave.imaging.edges.bounds import band_limited_bound, column_bound, mean_column_bound

if TYPE_CHECKING:
    from matplotlib.figure import Figure

RATIOS = (5.0, 7.0, 10.0, 14.0, 20.0, 30.0, 50.0, 70.0, 100.0)
BLURS = (0.5, 1.2, 2.0, 3.0)
SHAPE = (96, 512)
INNER = slice(20, -20)
SURFACES = 6
LIMIT_BLURS = (0.5, 0.8, 1.2, 1.6, 2.0, 2.5, 3.0)
LIMIT_RATIO, REPEATS = 20.0, 60
WAVELENGTH, WAVES = 20, 23
LIGHTINGS = ((0.0, 0.0), (0.1, -0.05))
"""Changes of brightness along and across the frames of the impact."""
FILM_FRAMES = 12
FILM_RATIO, FILM_BLUR = 20.0, 1.2
METHOD_MARGIN = 24
"""Columns next to the ends and the wires that the comparison of methods leaves out."""

Method = Callable[[np.ndarray, Array], Array]


def main() -> None:
    """Measure, and write picture and tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("docs", type=Path, nargs="?", default=Path(__file__).parents[1] / "docs")
    docs = parser.parse_args().docs
    picture = error_curves()
    (docs / "images").mkdir(parents=True, exist_ok=True)
    picture.savefig(docs / "images" / "edge_errors.png")
    (docs / "tables").mkdir(parents=True, exist_ok=True)
    for name, lines in (("edge_limits", limits()), ("edge_methods", methods())):
        text = "\n".join(lines) + "\n"
        print(text)
        (docs / "tables" / f"{name}.md").write_text(text, encoding="utf-8")


def measured(rows: Callable[[Array], Array], blur: float, ratio: float, seed: int) -> Edge:
    """The edge found in one noisy image."""
    return EdgeFinder(Optics(blur, True)).find(with_noise(edge_image(rows, SHAPE, blur), ratio, seed))


def column_error(blur: float, ratio: float) -> float:
    """Root mean square error of columns on a level edge at all places between two rows [px]."""
    truth = tilted(np.arange(float(SHAPE[1])))
    errors = [measured(tilted, blur, ratio, seed).column_rows - truth for seed in range(2 * SURFACES)]
    return rms(np.array(errors)[:, INNER])


def surface_error(blur: float, ratio: float) -> float:
    """Root mean square error, bias included, on surfaces that have every wavelength down to the resolution [px]."""
    resolution = EdgeFinder(Optics(blur, True)).resolution
    errors = []
    for seed in range(SURFACES):
        surface = band_limited(resolution, seed)
        truth = surface(np.arange(float(SHAPE[1])))
        errors.append(measured(surface, blur, ratio, 100 + seed).rows - truth)
    return rms(np.array(errors)[:, INNER])


def error_curves() -> Figure:
    """Errors against contrast over noise with the bounds, for several blurs, at both resolutions."""
    import matplotlib

    from wrinklewave.figures.style import COLOURS, RC, Margins, new_figure, panel_letter

    with matplotlib.rc_context(RC):
        drawing, axes = new_figure(7.4, 3.6, columns=2, margins=Margins(left=0.7, top=0.3))
        for blur, colour in zip(BLURS, COLOURS, strict=False):
            resolution = EdgeFinder(Optics(blur, True)).resolution
            bounds = (
                [mean_column_bound(ratio, blur) for ratio in RATIOS],
                [band_limited_bound(ratio, blur, resolution) for ratio in RATIOS],
            )
            found = (
                [column_error(blur, ratio) for ratio in RATIOS],
                [surface_error(blur, ratio) for ratio in RATIOS],
            )
            labels = (f"blur {blur:g} px", f"blur {blur:g} px, resolution {resolution:.3g} px")
            for panel, bound, errors, label in zip(axes, bounds, found, labels, strict=True):
                panel.loglog(RATIOS, bound, color=colour, lw=1.0)
                panel.loglog(RATIOS, errors, "o", ms=4, color=colour, label=label)
        for panel, letter, title in zip(
            axes, "AB", ("column by column", "regularised along the surface"), strict=True
        ):
            panel.set(
                xlabel="contrast over noise",
                ylabel="error, root mean square (px)",
                title=title,
                ylim=(4e-3, 1.0),
            )
            panel.legend(loc="upper right")
            panel_letter(panel, letter)
    return drawing


def limits() -> Iterator[str]:
    """What blur does: resolution, the amplitude that is kept, the bias of wrinkles, the noise."""
    yield (
        "| blur (px) | resolution (px) | contrast left at 10 px | bound (px) | bound at 10 px (px) "
        f"| columns, over bound | regularised, over bound | amplitude kept of {WAVELENGTH} px wrinkles "
        "| bias, 1 px amplitude (px) | bias, 3 px amplitude (px) |"
    )
    yield "|" + " --- |" * 10
    for blur in LIMIT_BLURS:
        resolution = EdgeFinder(Optics(blur, True)).resolution
        left = np.exp(-0.5 * (2 * np.pi / RESOLUTION) ** 2 * (blur**2 + 1 / 12))
        bound, finer = (band_limited_bound(LIMIT_RATIO, blur, at) for at in (resolution, RESOLUTION))
        columns = column_error(blur, LIMIT_RATIO) / mean_column_bound(LIMIT_RATIO, blur)
        surface = surface_error(blur, LIMIT_RATIO) / bound
        shallow, deep = (_wrinkles_found(blur, amplitude) for amplitude in (1.0, 3.0))
        yield (
            f"| {blur:g} | {resolution:.1f} | {left:.2f} | {bound:.3f} | {finer:.3f} | {columns:.2f} | {surface:.2f} "
            f"| {shallow[1]:.3f} | {shallow[0]:.3f} | {deep[0]:.3f} |"
        )


def _wrinkles_found(blur: float, amplitude: float) -> tuple[float, float]:
    """Bias (root mean square along a wavelength [px], noise taken off) and share of the amplitude kept.

    From the mean of all wavelengths of ``REPEATS`` noisy images.
    """
    surface = wrinkled(amplitude, float(WAVELENGTH))
    columns = np.arange(float(SHAPE[1]))[INNER][: WAVES * WAVELENGTH]
    found = np.array(
        [measured(surface, blur, LIMIT_RATIO, seed).rows[INNER][: columns.size] for seed in range(REPEATS)]
    )
    waves = found.reshape(REPEATS, WAVES, WAVELENGTH).mean(axis=1)
    mean, noise = waves.mean(axis=0), float(np.mean(waves.var(axis=0, ddof=1))) / REPEATS
    columns = columns[:WAVELENGTH]
    bias = np.sqrt(max(rms(mean - surface(columns)) ** 2 - noise, 0.0))
    return bias, float(2 * abs(np.mean(mean * np.exp(-2j * np.pi * columns / WAVELENGTH)))) / amplitude


def methods() -> Iterator[str]:
    """Errors of ways to find the edge on frames of one synthetic impact, under even and uneven lighting."""
    films = [synthetic_impact(lighting) for lighting in LIGHTINGS]
    frames, truths, columns = films[0]
    yield (
        f"{len(frames)} frames of {frames[0].shape[1]} x {frames[0].shape[0]} px of a synthetic impact, blur "
        f"{FILM_BLUR:g} px, contrast over noise {FILM_RATIO:g}; the bound of a single column is "
        f"{_mean_bound(truths, columns):.3f} px. Root mean square errors:"
    )
    yield ""
    yield "| method | even lighting (px) | a lamp that falls off by a tenth (px) |"
    yield "| --- | --- | --- |"
    for name, method in _all_methods().items():
        cells = []
        for frames, truths, columns in films:
            errors = np.array([method(frame, columns) for frame in frames]) - np.array(truths)
            cells.append(f"{rms(errors):.3f}")
        yield f"| {name} | {' | '.join(cells)} |"


def synthetic_impact(lighting: tuple[float, float]) -> tuple[list[np.ndarray], list[Array], Array]:
    """Frames of a travelling pulse with wrinkles, the true rows, and the columns that are compared."""
    from wrinklewave.imaging.camera import Camera, film
    from wrinklewave.wrinkling.travelling_pulse import TravellingPulse

    surface = TravellingPulse().surface()
    camera = Camera(shape=(256, 1152), scale=20e3, origin=(72.0, 160.0), blur=FILM_BLUR, gradient=lighting)
    recording = film(surface, camera.at_contrast_to_noise(FILM_RATIO), frames_before=0)
    assert recording.times is not None
    chosen = np.linspace(0.0, recording.n_frames - 1, FILM_FRAMES).astype(int)
    recording = film(surface, recording.camera, times=recording.times[chosen])
    truth = recording.truth()
    first = float(truth["boundary_column"].max()) + METHOD_MARGIN
    known = np.isfinite(truth["edge_row"].values).all(axis=0)
    last = np.flatnonzero(known)[-1] - METHOD_MARGIN
    columns = np.arange(np.ceil(first), last)
    frames = [recording.frame(index) for index in range(recording.n_frames)]
    return frames, [row[columns.astype(int)] for row in truth["edge_row"].values], columns


def _mean_bound(truths: list[Array], columns: Array) -> float:
    slopes = np.quantile(np.abs(np.gradient(np.array(truths), columns, axis=1)), np.linspace(0.02, 0.98, 25))
    return rms(np.array([column_bound(FILM_RATIO, FILM_BLUR, slope=slope) for slope in slopes]))


def _all_methods() -> dict[str, Method]:
    """Ways to find the edge by name."""
    finder = EdgeFinder(Optics(FILM_BLUR, False))

    def columnwise(frame: np.ndarray, columns: Array) -> Array:
        return finder.find(frame.astype(np.float32)).column_rows[columns.astype(int)]

    def regularised(frame: np.ndarray, columns: Array) -> Array:
        return finder.find(frame.astype(np.float32)).rows[columns.astype(int)]

    own: dict[str, Method] = {
        "this detector, column by column": columnwise,
        "this detector, regularised (10 px)": regularised,
        "centroid of a Gaussian gradient (1 px), ±4 px about its maximum": gradient_centroid,
    }
    try:
        import skimage.measure as measure
    except ImportError:
        return own
    return own | {
        "scikit-image `find_contours` at the middle grey": lambda frame, columns: contour(
            measure, frame.astype(float), columns
        ),
        f"`find_contours` after a Gaussian blur of {FILM_BLUR:g} px": lambda frame, columns: contour(
            measure, _blurred(frame), columns
        ),
    }


def gradient_centroid(frame: np.ndarray, columns: Array, half: int = 4) -> Array:
    """Centroid of the gradient of the smoothed grey values down each column, about its maximum."""
    from scipy.ndimage import gaussian_filter, uniform_filter

    gradient = gaussian_filter(frame.astype(float), 1.0, order=(1, 0))
    at = columns.astype(int)
    peak = np.abs(uniform_filter(gradient, 5))[:, at].argmax(axis=0)
    peak = np.clip(peak, half, frame.shape[0] - half - 1)
    rows = peak[None, :] + np.arange(-half, half + 1)[:, None]
    weight = gradient[rows, at[None, :]]
    return np.asarray((weight * rows).sum(axis=0) / weight.sum(axis=0))


def contour(measure: Any, image: Array, columns: Array) -> Array:
    """Row in each column of the longest contour at the grey value halfway between both sides; NaN where it folds."""
    low, high = np.percentile(image, [5, 95])
    lines = measure.find_contours(image, 0.5 * (low + high))
    longest = max(lines, key=len)
    on_columns = longest[longest[:, 1] == np.round(longest[:, 1])]
    rows = np.full(image.shape[1], np.nan)
    rows[on_columns[:, 1].astype(int)] = on_columns[:, 0]
    return rows[columns.astype(int)]


def _blurred(frame: np.ndarray) -> Array:
    from scipy.ndimage import gaussian_filter

    return np.asarray(gaussian_filter(frame.astype(float), FILM_BLUR))


if __name__ == "__main__":
    main()
