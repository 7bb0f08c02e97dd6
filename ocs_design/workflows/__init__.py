"""One page per command: read, compute, write; what is computed stands below."""
