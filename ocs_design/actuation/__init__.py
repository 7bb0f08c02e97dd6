"""A motor at a voltage behind a gear, and what it can do in a time."""
