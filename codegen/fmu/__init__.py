"""A model as a functional mock-up unit."""
