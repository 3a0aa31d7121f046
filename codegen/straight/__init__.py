"""The evaluation of one mode as straight-line functions, recorded from the evaluation itself."""
