"""Nodes as users write them and as checked elements: kinds, attributes, laws, composite ones."""
