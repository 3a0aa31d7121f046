"""Models of tens of thousands of states, in numbers."""
