"""Equations as a person reads them: text and LaTeX."""
