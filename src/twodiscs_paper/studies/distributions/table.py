"""The table of how the times to the next hop are distributed."""

from twodiscs.comparison.tables.base import COUNT, LENGTH, NUMBER, TEXT, TIME, Column, Table

SEE_QUANTITY = Column(float, "see quantity")
AS_ESTIMATE = Column(float, "as estimate")


class Distributions(Table):
    """
    One row per scene, radius and quantity: how the times to the next hop are distributed, from a
    hop (intervals T) and from a random moment (first passages F). Every T and every F has a start
    of its own.
    """

    scene: TEXT
    width: LENGTH
    height: LENGTH
    radius: LENGTH
    event: TEXT
    """the hop"""
    exact_mean: TIME
    """exact mean interval τ"""
    quantity: TEXT
    """
    mean: of T; squared_cv: CV² = ⟨T²⟩/τ² − 1; first_passage: ⟨F⟩, or ⟨min(F, c)⟩ where last is c;
    density_at_zero: p(0) of p(0) − at² in the first two bins of T; hazard: rate of hops when there
    was none since the last one, ln[P(T > first)/P(T > last)]/(last − first); rate: one hazard
    fitted by maximum likelihood to all bins from four mean times on, what is longer censored;
    trend: β of a hazard ∝ t^β there; plateau: the rate again, where it is constant for all that the
    data show; falling, falling_without_drift: where it is not, the hazard in the last two fifths of
    the time that the data reach, if discs that drift past each other avoid the hop and if not;
    over_cubic: hops there over those of the hazard 3/t of a cubic tail, where the hazard has fallen
    below three quarters of the rate
    """
    first: TIME
    """where the bin or the fit begins"""
    last: TIME
    """where it ends; for first_passage the cut c"""
    count: COUNT
    """intervals or first passages; those within the fit or bin"""
    estimate: SEE_QUANTITY
    """estimate, a time, 1/time or number"""
    stderr: AS_ESTIMATE
    """its standard error"""
    reference: AS_ESTIMATE
    """
    mean: τ; squared_cv: 1, that of an exponential law; first_passage: ⟨T²⟩/(2τ) = τ(1 + CV²)/2, or
    ⟨T² − (T − c)₊²⟩/(2τ) where cut, as measured; density_at_zero: exact; rate: 1/τ, which it would
    be if intervals were exponential; trend: 0
    """
    reference_stderr: AS_ESTIMATE
    """its standard error where it is measured"""
    z: NUMBER
    """
    (estimate − reference)/error; of a rate, how far intervals are from exponential at all times;
    empty where a cubic tail leaves F and T² without a variance: see the row with the cut
    """
    chi2: NUMBER
    """Pearson's χ² of a constant hazard"""
    degrees: COUNT
    """its degrees of freedom"""
    p: NUMBER
    """
    rate: probability of a larger χ² if the hazard is constant; trend: of a larger |z|. There is a
    plateau for all that is seen where neither is small
    """

    @classmethod
    def rows(cls, scenes, seed, events):
        """Return the rows of ``scenes`` (see ``measure.rows``)."""
        from twodiscs_paper.studies.distributions import measure, shape

        rows = [cls.empty(**row) for row in measure.rows(scenes, seed, events)]
        return rows + [cls.empty(**row) for row in shape.shapes(rows)]
