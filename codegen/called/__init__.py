"""Python functions of time as inputs: polynomials that miss them by no more than a tolerance."""
