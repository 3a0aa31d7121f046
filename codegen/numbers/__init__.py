"""Numbers: arrays, pairs of doubles, roots."""
