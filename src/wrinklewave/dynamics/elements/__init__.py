"""Elements as pure scalar functions of nodal values: the same arithmetic on every backend.

Nodes 1 to 4 run counter-clockwise from the lower left. A difference of nodal values between diagonally opposite
nodes is written d13 = value_1 - value_3 and d24 = value_2 - value_4.
"""
