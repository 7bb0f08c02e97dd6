"""One page per command: read, compute, write; the computations are in the packages below."""
