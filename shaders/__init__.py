"""GLSL files, one folder a pass; shared code in ``lib``."""
