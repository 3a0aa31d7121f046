"""How calls and runs of C end."""

from enum import IntEnum


class Status(IntEnum):
    """See ``run_status.h``, which says what each means."""

    OK = 0
    PARAMETER = 1
    COEFFICIENT = 2
    SINGULAR = 3
    NOT_FINITE = 4
    NO_SOLUTION = 5
    BAD_FRICTION = 6
    NO_HOLD = 7
    STRUCTURE = 8
    NEEDS_SLOPE = 9
    NOT_AFFINE = 10
    BAD_MODE = 11
    UNDECIDED = 12
    STALLS = 13
    STEPS = 14
    EVENTS = 15
    UNSTABLE = 16
    BAD_STEP = 17
    MISSING = 18
    NEGATIVE = 19
    STIFF = 20
    WORK = 21
    BLUNT = 22
    ENDLESS = 23
    CROWDED = 24
    REFUSED = 25
