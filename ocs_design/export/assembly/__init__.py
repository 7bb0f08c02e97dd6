"""How the device is put together, tested and wired: pictures and text for its builder."""
