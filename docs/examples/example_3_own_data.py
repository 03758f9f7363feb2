"""
3. A surface motion of your own
===============================

The analysis asks for a surface motion, not for its maker. Here one is put together from plain arrays: a pulse that runs
at a known speed with wrinkles of a known wavelength on it, and the analysis finds both.
"""

# %%
# Arrays in, dataset out
# ----------------------
# Heights on an even laboratory grid, the struck end, and some material points; SI units throughout.

import matplotlib.pyplot as plt
import numpy as np

import wrinklewave as ww
from wrinklewave.surface import surface_motion

speed, wavelength, amplitude = 50.0, 2.0e-3, 0.15e-3
time = np.linspace(0.0, 2.0e-3, 201)
x = np.linspace(0.0, 50e-3, 1001)
delay = time[:, None] - x / speed
pulse = 5e-3 * np.clip(delay / 1e-3, 0.0, 1.0) ** 2
wrinkles = amplitude * np.clip(delay / 0.5e-3, 0.0, 1.0) * np.cos(2 * np.pi * x / wavelength)
height = 18.5e-3 + pulse + wrinkles
points = np.linspace(0.0, 50e-3, 51)
surface = surface_motion(
    time=time,
    x=x,
    X=points,
    y=height,
    u_y=height - 18.5e-3,
    x_boundary=np.zeros_like(time),
    x_p=np.tile(points, (time.size, 1)),
    y_p=np.full((time.size, points.size), 18.5e-3),
    attrs={"kind": "measurement", "name": "made by hand", "length": 50e-3},
)

# %%
# Analysed like any other
# -----------------------
# The parameters are the section ``[analysis]`` of a case or an experiment.

settings = ww.load_case("../../examples/paper_impact.toml").analysis
found = ww.analyse(surface, settings)
wavefront = found.pulse.wavefront
peak = found.wrinkles.spectra.peak[-1]
print(f"wavefront {wavefront.speed:.2f} ± {wavefront.speed_sigma:.2f} m/s, put in: {speed} m/s")
print(f"wavelength {1e3 * peak:.3f} mm, put in: {1e3 * wavelength} mm")
print(f"amplitude {1e3 * found.wrinkles.amplitude[-1]:.4f} mm, put in: {1e3 * amplitude} mm")

# %%
# Pulse and wrinkles apart
# ------------------------

figure, (above, below) = plt.subplots(2, 1, figsize=(6, 5), sharex=True)
now = int(np.abs(time - 1e-3).argmin())
above.plot(1e3 * x, 1e3 * surface["u_y"][now], label="surface")
above.plot(1e3 * x, 1e3 * found.pulse.displacement[now], "k--", label="pulse")
above.set(ylabel="displacement [mm]")
above.legend()
below.plot(1e3 * x, 1e3 * found.wrinkles.height[now])
below.plot(1e3 * x, 1e3 * found.wrinkles.envelope[now], "k--")
below.set(xlabel="position [mm]", ylabel="wrinkles [mm]")
