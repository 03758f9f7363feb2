"""The paper's procedures, and the comparison with its numbers."""
