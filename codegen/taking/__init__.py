"""What a run records, taken while it goes on, by each backend."""
