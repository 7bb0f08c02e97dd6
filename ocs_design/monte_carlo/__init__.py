"""How often a design does its work in a world that is not as designed."""
