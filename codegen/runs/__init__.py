"""Runs of one model: events, integrators, exact steps, and what a run leaves behind."""
