"""A closed model in its modes: which ports stick, and what counts as zero."""
