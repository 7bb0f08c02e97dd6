"""Selection of the lightest device, over motors, gears, materials and incidences."""
