"""wrinklewave: a laboratory for waves and wrinkles in soft layered materials.

The whole of a day's work is at hand under one name, which the command line uses as well::

    import wrinklewave as ww

    run = ww.simulate("examples/quick.toml")  # a Run; with out="runs/quick" its results lie in a folder
    run.surface["u_y"]  # the surface motion, an xarray.Dataset in SI units
    run.summary["wavefront_speed_m_per_s"]  # what its analysis found

Importing the package is cheap: each name brings its module, and what that needs, when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from wrinklewave._version import __version__

if TYPE_CHECKING:
    from wrinklewave.analysis.analyse import analyse
    from wrinklewave.config.case import Case
    from wrinklewave.config.experiment import load_experiment
    from wrinklewave.config.reading import case_from_text, load_case
    from wrinklewave.experiments.compare import compare
    from wrinklewave.experiments.filming import film_run
    from wrinklewave.experiments.measure import Measurement, measure
    from wrinklewave.experiments.measure_quasi_static import measure_quasi_static
    from wrinklewave.experiments.quasi_static_test import quasi_static_test
    from wrinklewave.experiments.simulate import Run, simulate
    from wrinklewave.experiments.simulated_surface import rewrinkled
    from wrinklewave.experiments.sweep import sweep
    from wrinklewave.imaging.frames import open_recording
    from wrinklewave.surface import read as read_surface
    from wrinklewave.surface import write as write_surface
    from wrinklewave.theory.report import report as theory_report

__all__ = [
    "Case",
    "Measurement",
    "Run",
    "__version__",
    "analyse",
    "case_from_text",
    "compare",
    "film_run",
    "load_case",
    "load_experiment",
    "measure",
    "measure_quasi_static",
    "open_recording",
    "quasi_static_test",
    "read_surface",
    "rewrinkled",
    "simulate",
    "sweep",
    "theory_report",
    "write_surface",
]

_HOMES = {
    "Case": "config.case:Case",
    "Run": "experiments.simulate:Run",
    "Measurement": "experiments.measure:Measurement",
    "analyse": "analysis.analyse:analyse",
    "case_from_text": "config.reading:case_from_text",
    "compare": "experiments.compare:compare",
    "film_run": "experiments.filming:film_run",
    "load_case": "config.reading:load_case",
    "load_experiment": "config.experiment:load_experiment",
    "measure": "experiments.measure:measure",
    "measure_quasi_static": "experiments.measure_quasi_static:measure_quasi_static",
    "open_recording": "imaging.frames:open_recording",
    "quasi_static_test": "experiments.quasi_static_test:quasi_static_test",
    "read_surface": "surface:read",
    "rewrinkled": "experiments.simulated_surface:rewrinkled",
    "simulate": "experiments.simulate:simulate",
    "sweep": "experiments.sweep:sweep",
    "theory_report": "theory.report:report",
    "write_surface": "surface:write",
}
"""Where each public name is made: module and attribute."""


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, _, attribute = _HOMES[name].partition(":")
    value = globals()[name] = getattr(import_module(f"{__name__}.{module}"), attribute)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
