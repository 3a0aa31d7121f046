"""Sampled loops in numbers: what a period makes of small deviations."""
