"""``wrinklewave film``: a run as a high-speed camera would have seen it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from wrinklewave.cli.console import console

if TYPE_CHECKING:
    from collections.abc import Callable
    from contextlib import AbstractContextManager

    from wrinklewave.units import Dimension

Run = Annotated[Path, typer.Argument(metavar="RUN", help="Folder of a run, or its surface.nc.")]
Video = Annotated[
    Path, typer.Option("--out", metavar="VIDEO", help="Recording to write: .tif, .avi, .mp4 or .mov.")
]
Scale = Annotated[float, typer.Option(help="Pixels per millimetre.")]
FrameRate = Annotated[str, typer.Option(metavar="RATE", help="Of the camera.")]
Exposure = Annotated[str, typer.Option(metavar="TIME", help="For which each frame collects light.")]
Blur = Annotated[float, typer.Option(help="Standard deviation of the optics' blur in pixels.")]
Ratio = Annotated[
    float | None,
    typer.Option(metavar="RATIO", help="Even noise of this ratio instead of a sensor's shot and read noise."),
]
BitDepth = Annotated[
    int | None, typer.Option(metavar="BITS", help="Of the grey values; 12, or 10 in MP4 and MOV if left out.")
]
Tilt = Annotated[float, typer.Option(metavar="DEGREES", help="Of the sample in the image.")]
WirePlaces = Annotated[
    list[str] | None,
    typer.Option("--wire", metavar="X", help='Probe wire at this undeformed x, as "12 mm"; may be repeated.'),
]
Frames = Annotated[
    int | None, typer.Option(metavar="N", help="Number of pictures of a quasi-static run; 60 if left out.")
]
Seed = Annotated[int, typer.Option(help="Of the noise.")]
Threads = Annotated[int, typer.Option(metavar="N", min=1, help="Threads that render.")]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace an earlier recording of that name.")]


def film(
    run: Run,
    out: Video,
    scale: Scale = 20.0,
    frame_rate: FrameRate = "50 kHz",
    exposure: Exposure = "5 us",
    blur: Blur = 1.2,
    contrast_to_noise: Ratio = None,
    bit_depth: BitDepth = None,
    tilt: Tilt = 0.0,
    wire: WirePlaces = None,
    frames: Frames = None,
    seed: Seed = 0,
    threads: Threads = 2,
    overwrite: Overwrite = False,
) -> None:
    """Film a run with the synthetic camera: a recording, its truth, and an experiment file for measure."""
    from math import radians

    from wrinklewave.experiments.filming import film_run
    from wrinklewave.units import FREQUENCY, LENGTH, TIME

    usual = 10 if out.suffix.lower() in (".mp4", ".mov") else 12
    bits = usual if bit_depth is None else bit_depth
    camera: dict[str, Any] = {
        "frame_rate": _quantity("--frame-rate", frame_rate, FREQUENCY),
        "exposure": _quantity("--exposure", exposure, TIME),
        "blur": blur,
        "bit_depth": bits,
        "black_level": int(2.0**bits) // 64,
        "tilt": radians(tilt),
        "seed": seed,
    }
    with _progress() as show:
        filmed = film_run(
            run,
            out,
            scale=scale * 1e3,
            wires=[_quantity("--wire", place, LENGTH) for place in wire] if wire else None,
            contrast_to_noise=contrast_to_noise,
            frames=frames,
            threads=threads,
            overwrite=overwrite,
            progress=show,
            **camera,
        )
    height, width = filmed.film.shape
    ratio = filmed.film.camera.contrast_to_noise
    print(f"recording     {filmed.video}")
    print(f"              {filmed.film.n_frames} frames of {width} x {height} px, {bits} bit")
    print(f"              contrast to noise at the surface {ratio:.3g}")
    print(f"truth         {filmed.truth}")
    print(f"experiment    {filmed.experiment}")


def _quantity(option: str, text: str, dimension: Dimension) -> float:
    from wrinklewave.errors import InputError
    from wrinklewave.units import UnitError, parse

    try:
        return parse(text, dimension)
    except UnitError as error:
        raise InputError(str(error), key=option, expected=f"a {dimension.name}", cure=error.cure) from error


def _progress() -> AbstractContextManager[Callable[[int], None] | None]:
    """A bar on a terminal, nothing in a file."""
    from contextlib import contextmanager, nullcontext

    from rich.progress import Progress, TextColumn

    screen = console()
    if not screen.is_terminal:
        return nullcontext()

    @contextmanager
    def bar() -> Any:
        with Progress(
            TextColumn("filming frame {task.completed}"), console=screen, transient=True
        ) as progress:
            task = progress.add_task("", total=None)
            yield lambda number: progress.update(task, completed=number)

    return bar()
