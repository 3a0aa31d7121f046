"""Fixed steps of models whose ports hold or let go: complementarity problems at start and end."""
