"""From strokes to equations: the junction structure, and all that is folded away in it."""
