"""Runs that are written to files while they go on, so that memory does not grow with their samples."""
