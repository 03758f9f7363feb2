/* The yardstick: one time step of the same arithmetic, in the same order of passes, as a C compiler makes it.
 *
 * One-point quadrilaterals on a grid, one material with one Prony term whose bulk does not relax; struck left end,
 * roller below, free top with a wall at the far end, fixed right end. Symbols as in wrinklewave.dynamics.rows. */
#include <math.h>
#include <string.h>

/* Coordinates by row and by column, or those of every node, as a mesh that is no plain grid needs them. */
#ifdef ANY_MESH
#define OF_ROW(i) i
#define X_ABOVE(X, columns) ((X) + (columns) + 1)
#define X_FROM(a, place) ((a)->X + (place))
#else
#define OF_ROW(i) 0
#define X_ABOVE(X, columns) (X)
#define X_FROM(a, place) ((a)->X)
#endif

typedef const double *restrict In;
typedef double *restrict InOut;

typedef struct {
    long rows, columns; /* of elements */
    double *X, *Y, *u, *w, *vx, *vy, *inverse_mass;
    double *memory;  /* [6][rows][columns] */
    double *forces;  /* [2][8][columns + 2] */
    double *nothing; /* [8][columns + 2], zero */
    double *old;     /* [2][4][longest side]: left column and top row before the step */
    double mu, K, linear, quadratic, hourglass;
    double b, decay, b_next; /* Prony factors: of the last step, and of the one to come */
    double dt, length;
    double plate_speed; /* of the striker, in motion throughout */
    double totals[4];   /* work, loss in contact, impulses from the left and from the right */
} Block;

static inline double nearer(double y, double J) {
    double r = 1.0 - (y * y) * (J * y);
    return y + (y * r) * ((1.0 / 3.0 + 2.0 / 9.0 * r) + (r * r) * (14.0 / 81.0 + 35.0 / 243.0 * r));
}

static inline double inverse_cube_root(double J) {
    return nearer(nearer(1.8257 - J * (1.0325 - 0.2369 * J), J), J);
}

/* J^(-1/3) at the centre of element i, between two rows of nodes. */
static inline double root_at(long i, In X0, In X1, In Y0, In Y1, In u0, In u1, In w0, In w1) {
    long k = i + 1;
    double x13 = X0[i] - X1[k], y13 = Y0[OF_ROW(i)] - Y1[OF_ROW(k)];
    double x24 = X0[k] - X1[i], y24 = Y0[OF_ROW(k)] - Y1[OF_ROW(i)];
    double u13 = u0[i] - u1[k], u24 = u0[k] - u1[i], w13 = w0[i] - w1[k], w24 = w0[k] - w1[i];
    double inverse = 1.0 / (x13 * y24 - x24 * y13);
    double G11 = (y24 * u13 - y13 * u24) * inverse, G12 = (x13 * u24 - x24 * u13) * inverse;
    double G21 = (y24 * w13 - y13 * w24) * inverse, G22 = (x13 * w24 - x24 * w13) * inverse;
    return inverse_cube_root(1.0 + (G11 + G22 + G11 * G22 - G12 * G21));
}

static inline double remember(double *restrict Z, long i, double shape, double b, double decay, double b_next) {
    double H = Z[i] + b * shape;
    Z[i] = decay * H - b_next * shape;
    return H;
}

/* Forces of one row of elements between two rows of nodes (0 below, 1 above) on their corners. */
static void element_row(long n, In X0, In Y0, In Y1, In u0, In w0, In u1, In w1, In vx0, In vy0, In vx1, In vy1,
                        InOut Z0, InOut Z1, InOut Z2, InOut Z3, InOut Z4, InOut Z5, double mu, double K, double linear,
                        double quadratic, double hourglass, double b, double decay, double b_next, InOut f1x, InOut f1y,
                        InOut f2x, InOut f2y, InOut f3x, InOut f3y, InOut f4x, InOut f4y) {
    In X1 = X_ABOVE(X0, n);
#ifdef TWO_LOOPS /* J^(-1/3), a chain of operations that wait for each other, by itself; it lies where f1x will be */
    for (long i = 0; i < n; i++) f1x[i] = root_at(i, X0, X1, Y0, Y1, u0, u1, w0, w1);
#endif
    for (long i = 0; i < n; i++) {
        long k = i + 1;
        double x13 = X0[i] - X1[k], y13 = Y0[OF_ROW(i)] - Y1[OF_ROW(k)];
        double x24 = X0[k] - X1[i], y24 = Y0[OF_ROW(k)] - Y1[OF_ROW(i)];
        double hX = (X0[i] - X0[k]) + (X1[k] - X1[i]);
        double hY = (Y0[OF_ROW(i)] - Y0[OF_ROW(k)]) + (Y1[OF_ROW(k)] - Y1[OF_ROW(i)]);
        double u13 = u0[i] - u1[k], u24 = u0[k] - u1[i], w13 = w0[i] - w1[k], w24 = w0[k] - w1[i];
        double qx = (u0[i] - u0[k]) + (u1[k] - u1[i]), qy = (w0[i] - w0[k]) + (w1[k] - w1[i]);
        double A2 = x13 * y24 - x24 * y13, inverse = 1.0 / A2;
        double rate = ((vx0[i] - vx1[k]) * (y24 + w24) - (vx0[k] - vx1[i]) * (y13 + w13)) +
                      ((x13 + u13) * (vy0[k] - vy1[i]) - (x24 + u24) * (vy0[i] - vy1[k]));
        double G11 = (y24 * u13 - y13 * u24) * inverse, G12 = (x13 * u24 - x24 * u13) * inverse;
        double G21 = (y24 * w13 - y13 * w24) * inverse, G22 = (x13 * w24 - x24 * w13) * inverse;
        qx -= hX * G11 + hY * G12;
        qy -= hX * G21 + hY * G22;

        double F11 = 1.0 + G11, F22 = 1.0 + G22, e = G11 + G22 + G11 * G22 - G12 * G21, J = 1.0 + e;
#ifdef TWO_LOOPS
        double root = f1x[i];
#else
        double root = inverse_cube_root(J);
#endif
        double J23 = root * root, Ji = J23 * root;
        double C11 = F11 * F11 + G21 * G21, C22 = G12 * G12 + F22 * F22, C12 = F11 * G12 + G21 * F22;
        double t = (C11 + C22 + 1.0) * (1.0 / 3.0), tj = t * (Ji * Ji);
        double s11 = 1.0 - tj * C22, s22 = 1.0 - tj * C11, s12 = tj * C12, s33 = 1.0 - t;
        double A11 = mu * s11 + remember(Z0, i, s11, b, decay, b_next);
        double A22 = mu * s22 + remember(Z1, i, s22, b, decay, b_next);
        double A12 = mu * s12 + remember(Z2, i, s12, b, decay, b_next);
        double A33 = mu * s33 + remember(Z3, i, s33, b, decay, b_next);
        double H1 = remember(Z4, i, F11 * qx + G21 * qy, b, decay, b_next);
        double H2 = remember(Z5, i, G12 * qx + F22 * qy, b, decay, b_next);
        double Qx = mu * qx + Ji * (F22 * H1 - G21 * H2), Qy = mu * qy + Ji * (F11 * H2 - G12 * H1);

        double d13 = x13 * x13 + y13 * y13, d24 = x24 * x24 + y24 * y24;
        double L2 = 0.5 * A2 * A2 / (d13 > d24 ? d13 : d24);
        rate *= inverse * Ji;
        double compression = rate < 0.0 ? rate : 0.0;
        double p = K * e + linear * sqrt(L2) * rate - quadratic * L2 * compression * compression;
        double half = 0.5 * J23;
        double q = 0.5 * p - half * Ji * (A11 * C11 + A22 * C22 + 2.0 * A12 * C12 + A33) * (1.0 / 3.0);
        A11 *= half, A22 *= half, A12 *= half;
        double stiffness = hourglass * (7.0 / 72.0) * (d13 + d24) * inverse;
        Qx *= stiffness, Qy *= stiffness;

        double R = Qx * inverse;
        double T1 = F11 * A11 + G12 * A12 + q * F22 - hX * R, T2 = F11 * A12 + G12 * A22 - q * G21 - hY * R;
        double f1 = y24 * T1 - x24 * T2, f2 = x13 * T2 - y13 * T1;
        f1x[i] = f1 + Qx, f2x[i] = f2 - Qx, f3x[i] = Qx - f1, f4x[i] = -f2 - Qx;
        R = Qy * inverse;
        T1 = G21 * A11 + F22 * A12 - q * G12 - hX * R, T2 = G21 * A12 + F22 * A22 + q * F11 - hY * R;
        f1 = y24 * T1 - x24 * T2, f2 = x13 * T2 - y13 * T1;
        f1y[i] = f1 + Qy, f2y[i] = f2 - Qy, f3y[i] = Qy - f1, f4y[i] = -f2 - Qy;
    }
}

static void move_row(long n, double dt, In inverse_mass, InOut u, InOut w, InOut vx, InOut vy, In f1x, In f1y, In f2x,
                     In f2y, In f3x, In f3y, In f4x, In f4y) {
    for (long i = 0; i < n; i++) {
        double c = dt * inverse_mass[i];
        double v = vx[i] - c * ((f3x[i] + f4x[i + 1]) + (f1x[i + 1] + f2x[i]));
        vx[i] = v;
        u[i] += dt * v;
        v = vy[i] - c * ((f3y[i] + f4y[i + 1]) + (f1y[i + 1] + f2y[i]));
        vy[i] = v;
        w[i] += dt * v;
    }
}

static double *buffer(const Block *a, long j) { return a->forces + (j & 1) * 8 * (a->columns + 2); }

static void forces_of_row(const Block *a, long j) {
    long n = a->columns, stride = a->rows * n, P = n + 2, below = j * (n + 1), above = below + n + 1;
    double *Z = a->memory + j * n, *f = buffer(a, j) + 1;
    element_row(n, X_FROM(a, below), a->Y + below, a->Y + above, a->u + below, a->w + below, a->u + above,
                a->w + above, a->vx + below, a->vy + below, a->vx + above, a->vy + above, Z, Z + stride, Z + 2 * stride,
                Z + 3 * stride, Z + 4 * stride, Z + 5 * stride, a->mu, a->K, a->linear, a->quadratic, a->hourglass, a->b,
                a->decay, a->b_next, f, f + P, f + 2 * P, f + 3 * P, f + 4 * P, f + 5 * P, f + 6 * P, f + 7 * P);
}

static void move(const Block *a, long j, const double *below, const double *above) {
    long o = j * (a->columns + 1), P = a->columns + 2;
    move_row(a->columns + 1, a->dt, a->inverse_mass + o, a->u + o, a->w + o, a->vx + o, a->vy + o, above, above + P,
             above + 2 * P, above + 3 * P, below + 4 * P, below + 5 * P, below + 6 * P, below + 7 * P);
}

static long longest(const Block *a) { return (a->rows > a->columns ? a->rows : a->columns) + 1; }

static void remember_edges(const Block *a) {
    long N = a->columns + 1, M = longest(a);
    const double *fields[4] = {a->u, a->w, a->vx, a->vy};
    for (int f = 0; f < 4; f++) {
        for (long j = 0; j <= a->rows; j++) a->old[f * M + j] = fields[f][j * N];
        memcpy(a->old + (4 + f) * M, fields[f] + a->rows * N, N * sizeof(double));
    }
}

/* Keep node n out of a rigid plate on its left (side 1) or right (side -1); returns the impulse. */
static double push(Block *a, long n, const double *old, double plate, double plate_old, double side) {
    if (side * (a->X[n] + a->u[n] - plate) >= 0.0) return 0.0;
    double mass = 1.0 / a->inverse_mass[n], v = (plate - a->X[n] - old[0]) / a->dt, impulse = mass * (v - a->vx[n]);
    a->u[n] = plate - a->X[n];
    a->vx[n] = v;
    double work = impulse * (plate - plate_old) / a->dt;
    a->totals[0] += work;
    a->totals[1] += work - impulse * 0.5 * (old[2 * longest(a)] + v);
    return impulse;
}

static void apply_edges(Block *a, double plate, double plate_old) {
    long N = a->columns + 1, top = a->rows * N;
    const double *left = a->old, *above = a->old + 4 * longest(a);
    for (long i = 0; i < N; i++) a->w[i] = a->vy[i] = 0.0;
    for (long j = 0; j <= a->rows; j++) a->totals[2] += push(a, j * N, left + j, plate, plate_old, 1.0);
    for (long i = 1; i < N; i++) a->totals[2] += push(a, top + i, above + i, plate, plate_old, 1.0);
    for (long i = 1; i < N - 1; i++) a->totals[3] += push(a, top + i, above + i, a->length, a->length, -1.0);
    for (long j = 0; j <= a->rows; j++) {
        long n = j * N + a->columns;
        a->totals[3] -= a->vx[n] / a->inverse_mass[n];
        a->u[n] = a->w[n] = a->vx[n] = a->vy[n] = 0.0;
    }
}

/* The element kernel alone. */
void kernel(Block *a, long n_steps) {
    for (long s = 0; s < n_steps; s++)
        for (long j = 0; j < a->rows; j++) forces_of_row(a, j);
}

/* Whole steps from time t. */
void advance(Block *a, long n_steps, double t) {
    for (long s = 0; s < n_steps; s++) {
        remember_edges(a);
        for (long j = 0; j < a->rows; j++) {
            forces_of_row(a, j);
            move(a, j, j ? buffer(a, j - 1) : a->nothing, buffer(a, j));
        }
        move(a, a->rows, buffer(a, a->rows - 1), a->nothing);
        apply_edges(a, (t + (s + 1) * a->dt) * a->plate_speed, (t + s * a->dt) * a->plate_speed);
    }
}
