"""Runs in compiled C: the engine's sizes, its tables, its inputs."""
