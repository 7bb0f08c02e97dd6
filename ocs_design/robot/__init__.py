"""From a file or numbers to one frozen `Robot`."""
