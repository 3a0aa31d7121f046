"""Work, energy and integrals of a run: what to integrate, how, and the power balance."""
