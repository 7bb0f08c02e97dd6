"""From live values to the records of `design.json`, and from the records back to live values."""
