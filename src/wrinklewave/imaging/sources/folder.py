"""Folders of still images, one file per frame, in the order a person would count them."""

from __future__ import annotations

import re
import struct
from pathlib import Path
from typing import Any

import numpy as np

from wrinklewave.errors import InputError
from wrinklewave.imaging.frames import IMAGE_ENDINGS, FrameError, FrameSource, Image
from wrinklewave.imaging.sources.grey import COLOUR_NOTE, luma
from wrinklewave.imaging.sources.tiff import TiffSource

PNG_COLOUR_TYPES = {0: "grey", 2: "colour", 3: "palette", 4: "grey with alpha", 6: "colour with alpha"}


class FolderSource(FrameSource):
    """A folder of PNG or TIFF images of one size, 8 or 16 bit.

    Raises:
        InputError: if the folder holds no image, or none that can be read.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.path = path
        images = (entry for entry in path.iterdir() if entry.suffix.lower() in IMAGE_ENDINGS)
        self.files = sorted(images, key=lambda file: natural_order(file.name))
        if not self.files:
            raise InputError(
                "holds no images",
                file=path,
                expected=f"a folder of {', '.join(IMAGE_ENDINGS)} files, one per frame",
            )
        self.n_frames = len(self.files)
        first, self.bit_depth, colour = self._first_readable()
        self.shape = (first.shape[0], first.shape[1])
        self.white_level = (1 << self.bit_depth) - 1
        self.description = f"folder of {self.n_frames} images ({self.files[0].name} to {self.files[-1].name})"
        gaps = _missing_numbers(self.files)
        self.notes = ((COLOUR_NOTE,) if colour else ()) + ((gaps,) if gaps else ())

    def _read(self, index: int) -> Image:
        image, _, _ = _read_image(self.files[index], index)
        if image.shape != self.shape or image.dtype != self.dtype:
            found, wanted = _kind(image.shape, image.dtype), _kind(self.shape, self.dtype)
            reason = f"{self.files[index].name} is {found}, not {wanted}"
            raise FrameError(index, reason, source=self.path)
        return image

    def _first_readable(self) -> tuple[Image, int, bool]:
        for index, file in enumerate(self.files):
            try:
                return _read_image(file, index)
            except FrameError as error:
                self._unreadable[index] = error.reason
        raise InputError(
            f"none of its {self.n_frames} images can be read; the first: {self._unreadable[0]}",
            file=self.path,
            expected="8 or 16 bit PNG or TIFF images",
        )


def natural_order(name: str) -> list[Any]:
    """Sorting key in which frame_9 comes before frame_10."""
    parts = re.split(r"(\d+)", name.casefold())
    return [int(part) if part.isdigit() else part for part in parts]


def _kind(shape: tuple[int, ...], dtype: np.dtype) -> str:
    return f"{shape[1]} x {shape[0]} pixels of {8 * dtype.itemsize} bit"


def _missing_numbers(files: list[Path]) -> str | None:
    """A sentence if the last numbers in the names leave gaps: the frames would not be evenly spaced."""
    numbers = [int(found[-1]) for file in files if (found := re.findall(r"\d+", file.stem))]
    if len(numbers) != len(files) or len(set(numbers)) != len(numbers):
        return None
    missing = numbers[-1] - numbers[0] + 1 - len(numbers)
    return f"the numbers in the file names leave {missing} gaps: are frames missing?" if missing > 0 else None


def _read_image(file: Path, index: int) -> tuple[Image, int, bool]:
    """Grey values, bit depth, and whether the file was in colour.

    Raises:
        FrameError: naming the file and what is wrong with it.
    """
    try:
        if file.suffix.lower() == ".png":
            return _read_png(file)
        with TiffSource(file) as page:
            return page.frame(0), page.bit_depth, bool(page.notes)
    except FrameError as error:
        raise FrameError(index, f"{file.name}: {error.reason}") from error
    except InputError as error:
        raise FrameError(index, f"{file.name}: {error.problem}") from error
    except (OSError, SyntaxError, ValueError, struct.error) as error:
        raise FrameError(index, f"{file.name}: {error}") from error


def _read_png(file: Path) -> tuple[Image, int, bool]:
    from PIL import Image as Picture

    with file.open("rb") as raw:
        header = raw.read(26)
    if header[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("is no PNG image")
    stored, colour_type = struct.unpack(">BB", header[24:26])  # of the IHDR chunk, always the first
    if stored == 16 and colour_type != 0:
        raise ValueError(f"is 16 bit {PNG_COLOUR_TYPES[colour_type]}: save it as 16 bit grey")
    with Picture.open(file) as picture:
        if colour_type == 0:
            pixels = np.asarray(picture if stored in (8, 16) else picture.convert("L"))
            grey: Image = pixels.astype(np.uint16) if stored == 16 else pixels.astype(np.uint8)
            return grey, max(stored, 8), False
        if colour_type == 4:
            return np.asarray(picture.getchannel("L")), 8, False
        return luma(np.asarray(picture.convert("RGB"))), 8, True
