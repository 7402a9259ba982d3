"""Constraint functions, one file each."""
