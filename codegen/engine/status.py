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
    NO_SHARE = 8
    STRUCTURE = 9
    NEEDS_SLOPE = 10
    NOT_AFFINE = 11
    BAD_MODE = 12
    UNDECIDED = 13
    STALLS = 14
    STEPS = 15
    EVENTS = 16
    UNSTABLE = 17
    BAD_STEP = 18
    BEYOND = 19
    STRUCK = 20
    SET_TWICE = 21
    SET_HELD = 22
    SET_ENDLESSLY = 23
    TABLE_VALUE = 24
    PIVOTS = 25
    INACCURATE = 26
    UNEXCHANGED = 27
    INSTANTS = 28
    NOT_LATE = 29
    FORGETS = 30
    MISSING = 31
    NEGATIVE = 32
    STIFF = 33
    WORK = 34
    BLUNT = 35
    ENDLESS = 36
    CROWDED = 37
    REFUSED = 38
    UNTAKEN = 39
