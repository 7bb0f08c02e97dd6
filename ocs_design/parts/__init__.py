"""Parts of a module as exact solids, with the formulas for their strength."""
