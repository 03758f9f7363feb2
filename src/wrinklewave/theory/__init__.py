"""Theory: the closed forms that simulations and measurements are held against."""
