"""Derivations that a person can follow: the engine's decisions step by step, as equations and as text."""
