"""The molecular dynamics of each family of scenes; ``counting`` and its neighbours fetch it."""
