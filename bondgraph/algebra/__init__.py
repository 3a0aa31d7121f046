"""Exact algebra: expressions, rows of them, residues and ranks; floats decide nothing."""
