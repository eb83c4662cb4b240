"""The stadium demo: uses only what ``import tifo`` offers, as any game would."""
