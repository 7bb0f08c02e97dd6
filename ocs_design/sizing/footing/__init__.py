"""Footing: what holds the feet, be it the trunk itself, plates, posts, a mast or pedestals."""
