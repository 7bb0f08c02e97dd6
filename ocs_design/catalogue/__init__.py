"""What can be chosen, each row with its source."""
