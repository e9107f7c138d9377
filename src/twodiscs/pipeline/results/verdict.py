"""What the check tables of all scenes say together; read by a job that imports no NumPy."""


def failure(scene, row):
    """Return the sentence on a comparison that failed, naming quantity and radius."""
    where = "over all radii" if row["radius"] is None else f"at radius {row['radius']!r}"
    return (
        f"{scene}: {row['comparison']} of {row['quantity']} {where} by {row['method']} has "
        f"z = {row['z']:.3g}, beyond the bound {row['bound']:.3g}"
    )


def summary(scene, rows):
    """Return the sentence on a scene that passed, with how much of it says little."""
    tested = [row for row in rows if row["passed"] is not None]
    independent = sum(row["independent"] for row in tested)
    few = sum(row["status"] in ("too-few", "none-seen") for row in tested)
    largest = max((abs(row["z"]) for row in tested), default=0.0)
    return (
        f"{scene}: {len(tested)} comparisons passed, {independent} of them independent tests, "
        f"largest |z| {largest:.3g}; {few} had too few events for an error, "
        f"{len(rows) - len(tested)} more could not be compared"
    )


def verdict(tables):
    """Return (failures, text that sums up) of the check tables of scenes, {scene: rows}."""
    failures = [
        failure(scene, row)
        for scene, rows in tables.items()
        for row in rows
        if row["passed"] is False
    ]
    return failures, "".join(f"{summary(scene, rows)}\n" for scene, rows in tables.items())
