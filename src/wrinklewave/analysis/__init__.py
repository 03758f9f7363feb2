"""What surface motions tell: fronts and speeds, wrinkles apart from the pulse, amplitude, wavelength, strain.

Nothing here knows whether a surface motion was measured or simulated.
"""
