"""Scenes: what is asked, of which packing, under which load; read from TOML and checked."""
