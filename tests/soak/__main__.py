"""`python -m soak MINUTES [--family NAME] [--again]`: what `make soak` runs."""

import argparse
import os
import sys

from soak.families import FAMILIES, family
from soak.ledger import read, write
from soak.running import ran, soak


def main() -> int:
    """The status: 1 if a seed failed."""
    asked = argparse.ArgumentParser(prog="soak", description=__doc__)
    asked.add_argument("minutes", type=float)
    asked.add_argument("--family", action="append", choices=[one.name for one in FAMILIES])
    asked.add_argument("--again", action="store_true", help="only the seeds that failed before")
    given = asked.parse_args()
    chosen = [family(name) for name in given.family] if given.family else list(FAMILIES)
    records = read()
    if given.again:
        for one in chosen:
            for seed in list(records[one.name].failed):
                part = ran(one, range(seed, seed + 1))
                records[one.name].note(part.seeds, part.failing)
        write(records)
        return int(any(records[one.name].failed for one in chosen))
    bad = soak(chosen, records, given.minutes, os.cpu_count() or 1)
    return int(bool(bad))


if __name__ == "__main__":
    sys.exit(main())
