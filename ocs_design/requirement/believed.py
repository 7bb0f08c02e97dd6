"""Quantities that are soon given in another unit, and up to where their figures are believed."""

from math import pi

from ocs_design.requirement.values import ONE_TURN, Quantity, Sign, angle
from ocs_design.units import Dimension

FASTEST_BARE = 4000.0
"""[rad/s], 38,000 rpm: a larger wheel speed without a unit was meant in rpm."""

FASTEST_TURN = 50.0
"""[rad/s], eight turns a second: a larger rate without a unit was meant in degrees."""

HIGHEST_VOLTAGE = 1000.0
"""[V], beyond any robot's supply."""

MOST_TURNS = 10
"""Of a flip; no animal and no machine comes near."""

WHEEL_SPEED = Quantity(Dimension.ANGULAR_SPEED, most_bare=FASTEST_BARE, likely="rpm")
TRUNK_RATE = Quantity(Dimension.ANGULAR_SPEED, most_bare=FASTEST_TURN, likely="deg/s")
SUPPLY = Quantity(Dimension.VOLTAGE, most=HIGHEST_VOLTAGE, likely="mV")
INCIDENCE = angle(Sign.NOT_NEGATIVE, pi / 2)
TURN = angle(Sign.ANY, MOST_TURNS * 2.0 * pi, ONE_TURN)

TILT = angle(Sign.ANY, pi, pi / 2)
"""Upside down at most."""
