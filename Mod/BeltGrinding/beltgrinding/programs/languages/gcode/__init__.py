"""Reads 5-axis G-code: SINUMERIK, Fanuc and its like, LinuxCNC."""
