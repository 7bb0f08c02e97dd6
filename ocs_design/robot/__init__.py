"""Reads a robot from a file or from figures into one frozen `Robot`."""
