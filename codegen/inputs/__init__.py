"""Inputs over time: signals, and the polynomials times exponentials they are made of."""
