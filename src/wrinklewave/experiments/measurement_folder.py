"""The folder of a measured impact: what lies where, and how it is written."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wrinklewave.errors import InputError
from wrinklewave.experiments.boundary_history import boundary_columns
from wrinklewave.experiments.frame_blocks import BlockStore
from wrinklewave.experiments.run_folder import claim_folder, write_history, write_json, write_text

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr
    from numpy.typing import NDArray

    from wrinklewave.config.experiment import Experiment


@dataclass(frozen=True)
class MeasurementFolder:
    """Files of a measurement in ``path``."""

    path: Path

    @property
    def surface(self) -> Path:
        """The surface motion."""
        return self.path / "surface.nc"

    @classmethod
    def prepare(
        cls, path: Path, experiment: Experiment, *, resume: bool, overwrite: bool
    ) -> MeasurementFolder:
        """Make the folder ready for a measurement, and put the resolved experiment there.

        Raises:
            InputError: if it holds a measurement already and neither ``resume`` nor ``overwrite`` says what to
                do, or a finished one of another experiment is to be resumed, or if it holds a run.
        """
        if (path / "case.toml").exists():
            raise InputError("holds a run", file=path, cure="choose another folder with --out")
        claim_folder(path, "experiment.toml", "a measurement", resume=resume, overwrite=overwrite)
        folder, text = cls(path), experiment.to_toml()
        if not resume:
            folder._clear()
        elif folder._is_finished() and (path / "experiment.toml").read_text(encoding="utf-8") != text:
            raise InputError(
                "holds a finished measurement of another experiment file",
                file=path,
                cure="--overwrite replaces it, --out takes another folder",
            )
        write_text(path / "experiment.toml", text)
        return folder

    def blocks(self, origin: str, name: str = "") -> BlockStore:
        """Where measured frames are kept; ``origin`` says what they are measured of, ``name`` which of several."""
        return BlockStore(self.path / f".{name}frames", origin)

    def write_summary(self, summary: dict[str, Any]) -> None:
        """Scalar results."""
        write_json(self.path / "summary.json", summary)

    def write_tracks(self, columns: dict[str, NDArray[np.float64]]) -> None:
        """Struck end, striker and wires in every frame."""
        write_history(self.path / "tracks.csv", columns)

    def write_finished(self, surface: xr.Dataset, summary: dict[str, Any]) -> None:
        """What comes with the surface motion."""
        if surface["x_boundary"].notnull().sum() > 1:
            write_history(self.path / "boundary.csv", boundary_columns(surface))
        self.write_summary(summary)

    def _is_finished(self) -> bool:
        """Whether everything is written; the report comes last."""
        return (self.path / "report.html").exists()

    def _clear(self) -> None:
        for earlier in ("summary.json", "report.html", "*surface.nc", "*series.csv", ".*frames/*"):
            for file in self.path.glob(earlier):
                file.unlink()


@contextmanager
def opened_folder(
    experiment: Experiment, out: str | Path | None, *, resume: bool, overwrite: bool
) -> Iterator[MeasurementFolder]:
    """The folder for the results, or one that is gone afterwards."""
    if out:
        yield MeasurementFolder.prepare(Path(out), experiment, resume=resume, overwrite=overwrite)
        return
    with tempfile.TemporaryDirectory(prefix="wrinklewave-") as passing:
        yield MeasurementFolder.prepare(Path(passing), experiment, resume=False, overwrite=False)
