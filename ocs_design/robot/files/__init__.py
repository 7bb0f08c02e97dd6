"""From a path to a tree: sources, packages, meshes and what all formats share."""
