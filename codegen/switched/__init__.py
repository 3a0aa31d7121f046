"""Runs of models whose switches change their equations."""
