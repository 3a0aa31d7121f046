"""Sampled functions: their points, the polynomials between these, and the corners where such meet."""
