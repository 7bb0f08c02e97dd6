"""Push-off from the ground by optimal control: from a specified jump to leg references."""
