"""The GPU: all steps between two outputs in one launch, with the same functions as on the processor.

One thread computes one element, and later moves one node, which adds the forces of its elements in the processor's
order: no atomic operations, so runs are deterministic. The threads of the whole grid wait for each other between the
two (a cooperative launch). The state stays on the device; what an output needs is copied when it is due.
"""
