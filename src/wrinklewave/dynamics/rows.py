"""What the innermost loops do: an element, and a row of nodes.

The mesh is a grid of quadrilaterals, so a row of elements reads two rows of nodes at neighbouring places: no
connectivity, no gather. A row of elements writes the forces on its corners to a buffer of one row, and the nodes
between two rows are moved as soon as both buffers are full. The whole step so passes once over memory.

Arrays: ``X, Y`` undeformed positions [m], ``u, w`` displacements [m], ``vx, vy`` velocities [m/s], each
[n_node_rows, n_node_columns]; ``memory`` a tuple of arrays [n_element_rows, n_element_columns]: for each Prony term
the components 11, 22, 12, 33, hourglass 1, hourglass 2, and mean stress if the bulk relaxes; ``terms`` a tuple whose
length is the number of terms, known when the kernel is compiled so that its loop unrolls; ``factors`` [n_terms, 5]: b
of the last step, a and b of the next for the shear, then both b for the bulk;
``forces`` [8, n_element_columns + 2] or as many arrays: f1x, f1y, ... f4x, f4y, shifted by one column and zero at both
ends.
"""

from __future__ import annotations

from wrinklewave._jit import inlined_vector, scalar, strict, strict_vector, uintp
from wrinklewave.dynamics.elements.one_point import hourglass_stiffness, nodal_forces
from wrinklewave.dynamics.elements.quadrilateral import (
    bulk_viscosity,
    centre_gradient,
    opposite_differences,
    squared_length,
    twice_area,
    twice_area_rate,
)
from wrinklewave.dynamics.loops import heights, lanes, numbers, numbers_of_terms
from wrinklewave.dynamics.points import corners, corners_y
from wrinklewave.materials.neo_hookean import (
    first_piola_kirchhoff,
    inverse_cube_root,
    isochoric_shape,
    right_cauchy_green,
)
from wrinklewave.materials.prony import memory as next_memory
from wrinklewave.materials.prony import overstress

ONE = uintp(1)


@scalar
def differences(field, j, i):
    """Of a nodal field over element (j, i), see :func:`opposite_differences`."""
    v1, v2, v3, v4 = corners(field, j, i)
    return opposite_differences(v1, v2, v3, v4)


@scalar
def relaxed(memory, r, i, b, a, b_next, shape):
    """Overstress of one component now; its ``memory`` [n_rows, n_columns] of element (r, i) goes to the next step."""
    H = overstress(memory[r, i], b, shape)
    memory[r, i] = next_memory(H, a, b_next, shape)
    return H


@scalar
def differences_of_x(X, j, i):
    """Of undeformed x; ``X`` [n_columns] by column if columns are straight."""
    if X.ndim == 1:
        width = X[i] - X[i + ONE]
        return width, -width, 0.0
    return differences(X, j, i)


@scalar
def differences_of_y(Y, j, i):
    """Of undeformed y; ``Y`` as :func:`wrinklewave.dynamics.points.corners_y` takes it."""
    y1, y2, y3, y4 = corners_y(Y, j, i)
    return opposite_differences(y1, y2, y3, y4)


@scalar
def inverse_root(r, i, X, Y, u, w):
    """J^(-1/3) at the centre of element (r, i)."""
    x13, x24, _ = differences_of_x(X, r, i)
    y13, y24, _ = differences_of_y(Y, r, i)
    u13, u24, _ = differences(u, r, i)
    w13, w24, _ = differences(w, r, i)
    inverse = 1.0 / twice_area(x13, y13, x24, y24)
    G11, G12 = centre_gradient(x13, y13, x24, y24, inverse, u13, u24)
    G21, G22 = centre_gradient(x13, y13, x24, y24, inverse, w13, w24)
    return inverse_cube_root(1.0 + (G11 + G22 + G11 * G22 - G12 * G21))


@scalar
def one_point_element(r, i, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces):
    """Forces of element ``i`` of row ``r`` (unsigned), a one-point quadrilateral; ``memory`` goes to the next step.

    ``moduli``: long-term shear and bulk modulus [Pa], linear and quadratic bulk viscosity, hourglass factor.
    """
    root = inverse_root(r, i, X, Y, u, w)
    _one_point_forces(r, i, root, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces)


@scalar
def _one_point_forces(r, i, root, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces):
    mu, K, linear, quadratic, hourglass = moduli[0], moduli[1], moduli[2], moduli[3], moduli[4]
    stride = len(memory) // len(terms)
    bulk_relaxes = stride == 7
    k, s = i + ONE, r + ONE
    x13, x24, hX = differences_of_x(X, r, i)
    y13, y24, hY = differences_of_y(Y, r, i)
    u13, u24, qx = differences(u, r, i)
    w13, w24, qy = differences(w, r, i)
    A2 = twice_area(x13, y13, x24, y24)
    inverse = 1.0 / A2
    rate = twice_area_rate(
        x13 + u13,
        y13 + w13,
        x24 + u24,
        y24 + w24,
        vx[r, i] - vx[s, k],
        vy[r, i] - vy[s, k],
        vx[r, k] - vx[s, i],
        vy[r, k] - vy[s, i],
    )
    G11, G12 = centre_gradient(x13, y13, x24, y24, inverse, u13, u24)
    G21, G22 = centre_gradient(x13, y13, x24, y24, inverse, w13, w24)
    qx -= hX * G11 + hY * G12
    qy -= hX * G21 + hY * G22

    F11, F22 = 1.0 + G11, 1.0 + G22
    e = G11 + G22 + G11 * G22 - G12 * G21
    J23 = root * root
    Ji = J23 * root
    Ji2 = Ji * Ji
    C11, C22, C12 = right_cauchy_green(F11, G12, G21, F22)
    s11, s22, s12, s33 = isochoric_shape(C11, C22, C12, Ji2)

    q1, q2, Q1, Q2 = F11 * qx + G21 * qy, G12 * qx + F22 * qy, 0.0, 0.0
    A11, A22, A12, A33, p = mu * s11, mu * s22, mu * s12, mu * s33, K * e
    for m in range(len(terms)):
        b, a, b_next = factors[m][0], factors[m][1], factors[m][2]
        A11 += relaxed(memory[stride * m], r, i, b, a, b_next, s11)
        A22 += relaxed(memory[stride * m + 1], r, i, b, a, b_next, s22)
        A12 += relaxed(memory[stride * m + 2], r, i, b, a, b_next, s12)
        A33 += relaxed(memory[stride * m + 3], r, i, b, a, b_next, s33)
        Q1 += relaxed(memory[stride * m + 4], r, i, b, a, b_next, q1)
        Q2 += relaxed(memory[stride * m + 5], r, i, b, a, b_next, q2)
        if bulk_relaxes:
            p += relaxed(memory[stride * m + 6], r, i, factors[m][3], a, factors[m][4], e)

    L2 = squared_length(x13, y13, x24, y24, 0.5 * A2)
    p += bulk_viscosity(rate * inverse * Ji, L2, linear, quadratic)
    Qx, Qy = mu * qx + Ji * (F22 * Q1 - G21 * Q2), mu * qy + Ji * (F11 * Q2 - G12 * Q1)
    P11, P12, P21, P22 = first_piola_kirchhoff(
        F11, G12, G21, F22, A11, A22, A12, A33, C11, C22, C12, 0.5 * J23, Ji, 0.5 * p
    )
    stiffness = hourglass_stiffness(x13, y13, x24, y24, inverse, hourglass)
    f1, f2, f3, f4 = nodal_forces(x13, y13, x24, y24, inverse, P11, P12, hX, hY, stiffness * Qx)
    forces[0][k], forces[2][k], forces[4][k], forces[6][k] = f1, f2, f3, f4
    f1, f2, f3, f4 = nodal_forces(x13, y13, x24, y24, inverse, P21, P22, hX, hY, stiffness * Qy)
    forces[1][k], forces[3][k], forces[5][k], forces[7][k] = f1, f2, f3, f4


@inlined_vector
def one_point_row(j, start, stop, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces):
    """Forces of elements ``start`` to ``stop`` of row ``j``; ``forces`` are eight arrays.

    J^(-1/3), a chain of operations that wait for each other, has a loop of its own, in which the processor is at
    several elements at a time; it lies where the first force will be. What does not fill a vector is computed as one
    with a mask: a mesh of 165 columns would else spend a fifth of its time on the last 5.
    """
    r, first, end = uintp(j), uintp(start), uintp(stop)
    y, c, f = heights(Y, r), numbers(moduli), numbers_of_terms(factors, terms)
    full = end - (end - first) % uintp(lanes(u))
    for i in range(first, full):
        forces[0][i + ONE] = inverse_root(r, i, X, y, u, w)
    for i in range(first, full):
        _one_point_forces(r, i, forces[0][i + ONE], X, y, u, w, vx, vy, memory, terms, f, c, forces)
    if full < end:
        for lane in range(lanes(u)):
            i = full + uintp(lane)
            if i < end:
                one_point_element(r, i, X, y, u, w, vx, vy, memory, terms, f, c, forces)


@strict
def move_node(r, i, below, above, inverse_mass, dt_velocity, dt, u, w, vx, vy):
    """Move node ``i`` of row ``r`` by central differences, from the forces of the rows of elements beside it."""
    k = i + ONE
    c = dt_velocity * inverse_mass[r, i]
    fx = (below[4, i] + below[6, k]) + (above[0, k] + above[2, i])
    fy = (below[5, i] + below[7, k]) + (above[1, k] + above[3, i])
    v = vx[r, i] - c * fx
    vx[r, i] = v
    u[r, i] += dt * v
    v = vy[r, i] - c * fy
    vy[r, i] = v
    w[r, i] += dt * v


@strict_vector
def node_row(j, below, above, inverse_mass, dt_velocity, dt, u, w, vx, vy):
    """Move all nodes of row ``j``."""
    r, end = uintp(j), uintp(u.shape[1])
    full = end - end % uintp(lanes(u))
    for i in range(full):
        move_node(r, i, below, above, inverse_mass, dt_velocity, dt, u, w, vx, vy)
    if full < end:
        for lane in range(lanes(u)):
            i = full + uintp(lane)
            if i < end:
                move_node(r, i, below, above, inverse_mass, dt_velocity, dt, u, w, vx, vy)
