"""The lightest device that does all maneuvers, over motors, gears, materials and incidences."""
