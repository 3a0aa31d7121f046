"""What the tests run in: a guard against endless ones, compilers that share, a summary of what it took."""
