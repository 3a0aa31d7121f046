"""Runs of one affine model side by side in numpy, for sweeps."""
