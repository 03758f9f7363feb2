"""Explicit dynamics: elements, central differences, edges, energies, checkpoints."""
