"""Small models to step on one device and another: every edge, both elements, two materials; no case files needed."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import replace

import numpy as np

from support.bilayers import film_on_block, struck_bilayer
from support.models import K_0, MU_0, MU_1, RHO, TAU, Array, build, distorted, elastic, history, relaxing
from wrinklewave.dynamics.asking import answered_together
from wrinklewave.dynamics.backends import Device, March, Sample
from wrinklewave.dynamics.boundary import (
    FIXED,
    FREE,
    LEFT_HELD,
    LEFT_LINEAR,
    LEFT_MOVED,
    LEFT_STRAIGHT,
    LEFT_STRUCK,
    ROLLER,
    Boundary,
)
from wrinklewave.dynamics.drives import cubic_segments
from wrinklewave.dynamics.model import AT_REST, Model, assemble, subcycled
from wrinklewave.dynamics.simulation import Simulation
from wrinklewave.errors import RunError
from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.mesh.block import GridMesh

EVENTS = np.array([0.0, 0.4e-4, 1e-4])
"""An even and an uneven number of steps, and a change of their length."""
KNOTS = np.linspace(0.0, 1e-3, 9)
PUSH = cubic_segments(KNOTS, lambda t: 3e3 * t**2, lambda t: 6e3 * t)
STRIKE = cubic_segments(KNOTS, lambda t: 10.0 * t, lambda t: 10.0 + 0.0 * t)
SHEAR = cubic_segments(KNOTS, lambda t: 1e3 * t**2, lambda t: 2e3 * t)


def struck(precision: str = "double") -> Model:
    """A plate with friction strikes the upper half of a block, which stands on a wall."""
    return build(
        distorted(6, 4),
        relaxing(bulk=False),
        "one-point",
        left=LEFT_STRUCK,
        right=FIXED,
        bottom=ROLLER,
        wall=True,
        friction=0.05,
        motion=STRIKE,
        bulk_viscosity=(0.06, 1.2),
        precision=precision,
    )


def mixed() -> Model:
    """As :func:`struck`, with state and elements in single precision."""
    return struck("mixed")


GROOVE = np.array(
    [
        *((0, 3), (1.3, 3), (2.6, 3), (3.9, 3), (3.8, 2.0), (4.3, 1.3), (5, 1.2)),
        *((5.7, 1.3), (6.2, 2.0), (6.1, 3), (7.4, 3), (8.7, 3), (10, 3)),
    ]
)
"""A surface with an undercut groove [mm]: it overhangs."""


def grooved(*, film: bool = False) -> Model:
    """The lips of a groove pass each other; more nodes than the simulated GPU has threads."""
    share = np.linspace(0.0, 1.0, 6)[:, None]
    mesh = GridMesh(
        X=((1 - share) * np.linspace(0, 10, 13) + share * GROOVE[:, 0]) * 1e-3,
        Y=share * GROOVE[:, 1] * 1e-3,
        layer=np.zeros((5, 12), dtype=np.int64),
    )
    mesh.layer[-1] = film
    boundary = Boundary(
        *(LEFT_HELD, FIXED, FREE, FREE, False, 10e-3, 0.0, PUSH, AT_REST, np.zeros((3, 4, 13))),
        bins=np.zeros((3, 2, 13), dtype=np.int64),
    )
    solids = [relaxing(bulk=False), *([elastic(mu=4e6, K=1e8)] if film else [])]
    model = assemble(mesh, solids, boundary)
    closing = np.array([0, 0.4, 0.8, 1.2, 1.15, 0.5, 0, -0.5, -1.15, -1.2, -0.8, -0.4, 0]) * 1e-3
    model.arrays.u[:] = share * closing
    model.arrays.vx[:] = (3e4 if film else 1e4) * share * closing
    return subcycled(model) if film else model


def filmed_groove() -> Model:
    """As :func:`grooved`, with a stiff skin whose rows have steps of their own."""
    return grooved(film=True)


def filmed(ratio: float = 42.0, precision: str = "double", **mesh: float) -> Model:
    """A plate strikes a block with a film; rows of elements have steps of their own."""
    squares = film_on_block(columns=6, rows=4, size=1e-3, **mesh)
    return struck_bilayer(mesh=squares, ratio=ratio, precision=precision, motion=STRIKE)


def filmed_in_mixed() -> Model:
    """As :func:`filmed`, with state and elements in single precision."""
    return filmed(precision="mixed")


def filmed_softly() -> Model:
    """As :func:`filmed`; the film's steps are fewer to one of the substrate's."""
    return filmed(ratio=3.0)


def filmed_evenly() -> Model:
    """As :func:`filmed`, with a film in rows like those below; all take one step."""
    return filmed(ratio=1.5, thickness=2.0)


def bilayer() -> Model:
    """Two materials, one with two Prony terms; the stiff one ends early; under an end that moves and stays straight."""
    mesh = distorted(6, 4, seed=1)
    layer = mesh.layer.copy()
    layer[-1, :4] = 1
    boundary = Boundary(
        LEFT_STRAIGHT, ROLLER, FREE, ROLLER, True, 6e-3, 0.0, PUSH, AT_REST, np.zeros((3, 4, 7))
    )
    soft = Viscoelastic(RHO, MU_0, K_0, np.array([MU_1, MU_0]), np.zeros(2), np.array([TAU, 10 * TAU]))
    return assemble(GridMesh(mesh.X, mesh.Y, layer), [soft, elastic(mu=4e5, K=2e6)], boundary)


def sheared() -> Model:
    """The fully integrated element with a relaxing bulk, its end moved along and across, the right one free."""
    mesh = distorted(6, 4, seed=2)
    boundary = Boundary(LEFT_LINEAR, FREE, FREE, ROLLER, False, 6e-3, 0.0, PUSH, SHEAR, np.zeros((3, 4, 7)))
    return assemble(mesh, [relaxing(bulk=True)], boundary, one_point=False)


def compressed() -> Model:
    """A whole block, made heavy, pressed along x only; its surfaces are free."""
    mesh = distorted(6, 4, seed=3)
    boundary = Boundary(LEFT_MOVED, FIXED, FREE, FREE, True, 6e-3, 0.0, PUSH, AT_REST, np.zeros((3, 4, 7)))
    return assemble(mesh, [relaxing(bulk=False)], boundary, mass_scaling=4.0)


def sheared_otherwise() -> Model:
    """As :func:`sheared`, of another solid and mesh, under a history of fewer pieces."""
    mesh, solid = distorted(6, 4, seed=4), relaxing(bulk=True)
    across = cubic_segments(KNOTS[[0, 2, 8]], lambda t: 2e3 * t**2, lambda t: 4e3 * t)
    boundary = Boundary(LEFT_LINEAR, FREE, FREE, ROLLER, False, 6e-3, 0.0, PUSH, across, np.zeros((3, 4, 7)))
    return assemble(mesh, [replace(solid, mu_inf=2 * MU_0)], boundary, one_point=False)


def grooved_softly() -> Model:
    """As :func:`grooved`, of a softer solid."""
    model = grooved()
    model.arrays.terms[:, :, 0] *= 0.5
    return model


def overrun() -> Model:
    """A plate at 3 km/s: nothing is finite after the first steps."""
    motion = cubic_segments(KNOTS, lambda t: 3e3 * t, lambda t: 3e3 + 0.0 * t)
    return build(distorted(6, 4), relaxing(bulk=False), "one-point", left=LEFT_STRUCK, motion=motion)


BATCHES: tuple[tuple[Callable[[], Model], ...], ...] = (
    (struck, overrun, compressed),
    (sheared, sheared_otherwise),
    (grooved_softly, grooved),
    (filmed_evenly, filmed, filmed_softly),
)
"""Members have one shape; their materials, meshes, edges, histories and steps differ."""
MODELS: dict[str, Callable[[], Model]] = {
    f.__name__: f
    for f in (struck, mixed, grooved, bilayer, sheared, compressed, filmed, filmed_in_mixed, filmed_groove)
}


def simulation_of(model: Model, device: Device) -> Simulation:
    """Through the events of all tests."""
    return Simulation(model, EVENTS, device=device, history_interval=2.5e-5)


def run(model: Model, device: Device) -> dict[str, Array]:
    """State, fields, totals and history at the end."""
    simulation = simulation_of(model, device)
    for _ in simulation.run():
        pass
    return results(simulation)


def to_the_end(simulation: Simulation) -> Generator[March, Sample, dict[str, Array]]:
    """The marches of a whole run."""
    while simulation.has_events:
        yield from simulation.to_next_event()
    return results(simulation)


def run_together(simulations: Sequence[Simulation]) -> list[dict[str, Array] | RunError]:
    """What the runs of a batch lead to, or the errors that they failed with."""
    from wrinklewave.dynamics.cuda.backend import Batch

    batch = Batch([simulation.model for simulation in simulations])
    for simulation, member in zip(simulations, batch.members(), strict=True):
        simulation.backend = member
    found = dict(answered_together([to_the_end(simulation) for simulation in simulations], batch.march))
    return [found[place] for place in range(len(simulations))]


def results(simulation: Simulation) -> dict[str, Array]:
    """What a run leaves behind, by name."""
    simulation.backend.fetch_all()
    a = simulation.model.arrays
    state = {"u": a.u, "w": a.w, "vx": a.vx, "vy": a.vy, "memory": simulation.model.memory}
    if simulation.model.row_steps is not None:
        state |= {f"rows_{name}": values for name, values in simulation.model.row_steps._asdict().items()}
    state |= {"counts": simulation.counts}
    return state | {"fields": simulation.fields(), "totals": simulation.totals} | history(simulation)
