"""Boresight's Python side. The simulator and the oracle are the program `boresight`."""
