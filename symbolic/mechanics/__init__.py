"""Contacts, force balance and the paths of a force, linearised."""
