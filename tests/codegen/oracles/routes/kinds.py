"""All kinds, in the order of the table."""

from oracles.routes.friction import FRICTION
from oracles.routes.lawful import LAWFUL
from oracles.routes.plain import PLAIN
from oracles.routes.sloped import SLOPED
from oracles.routes.stops import STOPS
from oracles.routes.switches import SWITCHES

KINDS = {make.__name__: make for make in (*FRICTION, *SLOPED, *SWITCHES, *STOPS, *PLAIN, *LAWFUL)}
