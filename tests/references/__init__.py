"""Reference solutions, written apart from the package, that the tests compare it with."""
