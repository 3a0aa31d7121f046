"""Causal strokes: assigned, told as stories, refused with the expression that vanishes."""
