"""Geometry and order of pictures, whatever they show: rectangles, layers, lines that keep clear."""
