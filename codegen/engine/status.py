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
    BEYOND = 18
    STRUCK = 19
    MISSING = 20
    NEGATIVE = 21
    STIFF = 22
    WORK = 23
    BLUNT = 24
    ENDLESS = 25
    CROWDED = 26
    REFUSED = 27
