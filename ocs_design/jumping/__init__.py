"""Push-off from the ground by optimal control: from a jump that is asked for to leg references."""
