"""Blocks of block diagrams as functions of nodes: gains, limits, transfer functions, controllers."""
