"""The proof: robot, device and floor in MuJoCo, the paper's law, its maneuvers, what came of it."""
