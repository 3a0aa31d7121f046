"""A program with numbers: everything at one instant, in each friction mode."""
