"""Closed loops: an active differential in a car, its clutches led by a sampled controller."""
