"""Graphs judged: doubts and hints with the way out, drawn strokes, causal paths, junctions merged."""
