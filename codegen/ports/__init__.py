"""Friction ports at an instant: what they receive, what holds them, how they share."""
