"""Meshes: blocks and bilayers of quadrilaterals in rows and columns, graded, with an imperfect surface."""
