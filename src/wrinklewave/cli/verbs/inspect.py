"""``wrinklewave inspect``: what a recording holds."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from wrinklewave.cli.console import console

Recording = Annotated[
    Path, typer.Argument(metavar="VIDEO", help="TIFF stack, folder of images, .cine, AVI, MP4 or MOV.")
]
Folder = Annotated[
    Path, typer.Option("--out", metavar="DIR", help="Where contact sheet and experiment file go.")
]


def inspect(video: Recording, out: Folder = Path()) -> None:
    """Say what a recording holds; write a contact sheet and a suggested experiment file."""
    from rich.markup import escape

    from wrinklewave.figures.contact_sheet import contact_sheet
    from wrinklewave.figures.style import PNG
    from wrinklewave.imaging.frames import open_recording
    from wrinklewave.imaging.inspection import facts, grey_warnings, histogram, suggested_experiment

    out.mkdir(parents=True, exist_ok=True)
    screen = console()
    with open_recording(video.absolute()) as source:
        grey = histogram(source)
        sheet = out / f"{video.stem}.contact-sheet.png"
        contact_sheet(source, grey).savefig(sheet, **PNG)
        for name, value in facts(source, grey).items():
            screen.print(f"{name:14}{escape(value)}", highlight=False)
        for warning in (*source.notes, *grey_warnings(source, grey)):
            screen.print(f"[yellow]note[/yellow]          {escape(warning)}", highlight=False)
        text = suggested_experiment(source, out.absolute())
    experiment = out / f"{video.stem}.experiment.toml"
    kept = experiment.exists()
    if not kept:
        experiment.write_text(text, encoding="utf-8")
    print(f"contact sheet {sheet}")
    print(f"experiment    {experiment}{' (there was one already: kept as it is)' if kept else ''}")
