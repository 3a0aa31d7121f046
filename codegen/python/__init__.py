"""A model as one Python module."""
