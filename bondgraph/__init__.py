"""Symbolic bond graphs: declared with networkx, derived into ``A x' = J x + B u``, slip ``= F x``."""

from bondgraph.offering import offer

__all__ = offer(__name__)
