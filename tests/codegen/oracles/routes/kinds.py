"""All kinds, in the order of the table."""

from oracles.routes.blocks import BLOCKS
from oracles.routes.cornered import CORNERED
from oracles.routes.delayed import DELAYED
from oracles.routes.exchanging import EXCHANGING
from oracles.routes.friction import FRICTION
from oracles.routes.jumping import JUMPING
from oracles.routes.lawful import LAWFUL
from oracles.routes.looped import LOOPED
from oracles.routes.machines import MACHINES
from oracles.routes.plain import PLAIN
from oracles.routes.resetting import RESETTING
from oracles.routes.searched import SEARCHED
from oracles.routes.signals import SIGNALS
from oracles.routes.sloped import SLOPED
from oracles.routes.stops import STOPS
from oracles.routes.supplied import SUPPLIED
from oracles.routes.switches import SWITCHES
from oracles.routes.tabled import TABLED

EVERY = (
    *FRICTION, *JUMPING, *SLOPED, *SWITCHES, *STOPS, *RESETTING, *CORNERED, *PLAIN, *LAWFUL, *LOOPED,
    *SUPPLIED, *TABLED, *SEARCHED, *EXCHANGING, *SIGNALS, *BLOCKS, *MACHINES, *DELAYED,
)  # fmt: skip

KINDS = {make.__name__: make for make in EVERY}
