"""Registries of figures: what each shows and when it can be drawn, and writing all of a registry."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Generic, TypeVar

from wrinklewave.figures.style import PNG, RC

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from wrinklewave.figures.beside import Helper

Inputs = TypeVar("Inputs")


@dataclass(frozen=True)
class FigureSpec(Generic[Inputs]):
    """A figure that can be drawn.

    Attributes:
        name: file name without its ending.
        number: of the paper's figure, such as "2C"; empty if there is none.
        caption: what it shows.
        draw: makes it.
        possible: whether the inputs hold what it needs.
        measured: name and number of the same figure in the paper's arrangement where all surface motions were
            measured.
    """

    name: str
    number: str
    caption: str
    draw: Callable[[Inputs], Figure]
    possible: Callable[[Inputs], bool]
    measured: tuple[str, str] | None = None

    def of(self, kinds: Collection[str]) -> FigureSpec[Inputs]:
        """The figure as it is called for surface motions of these kinds, "simulation" or "measurement"."""
        if self.measured is None or set(kinds) != {"measurement"}:
            return self
        return replace(self, name=self.measured[0], number=self.measured[1])


class Registry(dict[str, FigureSpec[Inputs]], Generic[Inputs]):
    """Figures that are drawn from one kind of inputs, by name, in the order in which they were registered.

    Args:
        place: "module:name" under which another process finds it.
    """

    def __init__(self, place: str) -> None:
        super().__init__()
        self.place = place

    def figure(
        self,
        name: str,
        *,
        number: str,
        caption: str,
        possible: Callable[[Inputs], bool] = lambda inputs: True,
        measured: tuple[str, str] | None = None,
    ) -> Callable[[Callable[[Inputs], Figure]], Callable[[Inputs], Figure]]:
        """Register a function that draws a figure; it is called with the style of this package in force."""

        def register(draw: Callable[[Inputs], Figure]) -> Callable[[Inputs], Figure]:
            def styled(inputs: Inputs) -> Figure:
                import matplotlib

                with matplotlib.rc_context(RC):
                    return draw(inputs)

            self[name] = FigureSpec(name, number, caption, styled, possible, measured)
            return styled

        return register

    def write(
        self, folder: str | Path, inputs: Inputs, *, kinds: Collection[str], helper: Helper | None = None
    ) -> dict[str, Path]:
        """Write every figure that is possible as PNG; return the files by name.

        Args:
            folder: made if need be.
            inputs: what figures are drawn from.
            kinds: of the surface motions in them, "simulation" or "measurement".
            helper: draws part of them beside this process.
        """
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        files = {
            name: folder / f"{spec.of(kinds).name}.png"
            for name, spec in self.items()
            if spec.possible(inputs)
        }
        theirs = dict(list(files.items())[1::2]) if helper else {}
        if helper:
            helper.begin(self.place, inputs, theirs)
        self.draw(inputs, {name: file for name, file in files.items() if name not in theirs})
        if helper and not helper.has_drawn():
            self.draw(inputs, theirs)
        return files

    def draw(self, inputs: Inputs, files: Mapping[str, Path]) -> None:
        """Draw figures, by name, into PNG files."""
        import matplotlib

        for name, file in files.items():
            drawing = self[name].draw(inputs)
            with matplotlib.rc_context(RC):
                drawing.savefig(file, **PNG)
