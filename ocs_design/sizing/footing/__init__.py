"""What holds the feet: the trunk itself, plates, posts, a mast or pedestals."""
