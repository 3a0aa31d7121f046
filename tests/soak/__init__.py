"""Families of random models: what a run of the tests takes of each, and what a soak goes on with."""
