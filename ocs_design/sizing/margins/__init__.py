"""How much of the motor, the gear, the rim and the supply a motion takes."""
