"""Up to where figures are believed; beyond, they were meant in another unit."""

FASTEST_BARE = 4000.0
"""[rad/s], 38,000 rpm: a larger wheel speed without a unit was meant in rpm."""

FASTEST_TURN = 50.0
"""[rad/s], eight turns a second: a larger rate without a unit was meant in degrees."""

HIGHEST_VOLTAGE = 1000.0
"""[V], beyond any robot's supply."""

MOST_TURNS = 10
"""Of a flip; no animal and no machine comes near."""

ONE_TURN = 6.3
"""[rad], to two digits: a larger bare number was meant in degrees."""
