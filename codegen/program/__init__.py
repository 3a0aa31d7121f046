"""Equations and laws as named assignments that every backend prints."""
