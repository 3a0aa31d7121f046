"""Differentials of Deur, Hancock and Assadian (2008), in closed loops, and parts to build others from."""

from bondgraph.offering import offer

__all__ = offer(__name__, ("parts",))
