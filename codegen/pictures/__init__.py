"""Pictures of runs and of linear models. Needs matplotlib, the optional extra ``pictures``."""
