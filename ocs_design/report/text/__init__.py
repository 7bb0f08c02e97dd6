"""Facts in a terminal, on standard error."""
