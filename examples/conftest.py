"""What is not collected where something is missing that no part of the toolkit needs."""

from importlib.util import find_spec

collect_ignore = [] if find_spec("gymnasium") else ["clutch_environment.py"]
