"""tifo fills a stadium with animated spectators."""

__version__ = "0.1.0"
