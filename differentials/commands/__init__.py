"""The command line, built with click: the optional extra ``cli``."""
