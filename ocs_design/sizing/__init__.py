"""How large: the incidence of the wheel axes, the rim, and both on the robot that carries them."""
