"""Web and hub: closed forms against solids that are put together, and what they ask of a rim."""
