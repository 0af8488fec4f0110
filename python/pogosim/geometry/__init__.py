"""Arenas: reading, checking, scaling, converting and drawing their outlines."""
