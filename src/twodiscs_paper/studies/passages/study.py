"""Which hops are passages, and how fast discs diffuse by them."""

from twodiscs.analysis.columns import (
    COUNT,
    HEIGHT,
    NUMBER,
    RADIUS,
    TEXT,
    TIME,
    WIDTH,
    Column,
    Table,
    Z,
)
from twodiscs.figures.scene_figures import DYNAMICS, Figure
from twodiscs.model.events import HOPS
from twodiscs_paper.study import AS_ESTIMATE, Study, scaled


class PassagesTable(Table):
    """
    One row per quantity of the hops of one kind at one radius: which of them are passages, how fast
    they make discs diffuse along a ring.
    """

    columns = {
        "scene": TEXT(
            "the scene; empty for the limit of any hop; pore: two spheres in a cylindrical pore of "
            "the length width and the diameter height, with hits of an end (right_wall) and of the "
            "side (top_wall) by one sphere"
        ),
        "width": WIDTH,
        "height": HEIGHT,
        "periodic": TEXT("axes without walls; empty if both have walls"),
        "event": TEXT("the hop; empty for the limit of any hop"),
        "discs": COUNT("number of discs"),
        "radius": RADIUS,
        "distance": NUMBER(
            "(r_c − r)/r_c, the relative distance below the radius r_c at which the hop becomes "
            "blocked"
        ),
        "moment_of_inertia": Column(
            float, "m r²", "moment of inertia of rough discs; empty for smooth discs"
        ),
        "friction": Column(
            float,
            "1/time",
            "rate γ of kicks, at which all velocities are drawn anew; empty without friction; by "
            "the method limit x = γ√(εσ)",
        ),
        "exact_mean": TIME("exact mean time τ between hops, in both directions together"),
        "quantity": TEXT(
            "correlation: C(t) = 1 + 2⟨Σ s_0 s_k⟩ of the directions of hops, between walls the "
            "transmission coefficient κ(t); slope: −dκ/dt at 0⁺; coefficient: the fraction κ of "
            "hops that are passages, by clusters of hops without a pause; plateau: the same from "
            "κ(t); passage_time: τ/κ; exponent: of 1 − κ for smooth discs, of κ for rough ones, "
            "as powers of the distance, from this distance and the one before; last_exponent: the "
            "same, fitted to the last five distances; law_exponent: the same of c + a δ^(1/6) + "
            "b δ^(1/3), with the limit c and a and b fitted to (1 − κ)A/∛(εσ²) from 2⁻¹³ on, "
            "law_chi2: its χ²; local_exponent: of the time between passages "
            "with friction, from this distance and the one before, without the regular factor of "
            "τ: −2 + |d ln κ/d ln x|/2, or −5/2 in place of −2 in a pore; scaled_coefficient: κ x, "
            "x = γ√(εσ); scaling_constant: b "
            "of 1/κ = x/k + 1/(1 + b x + c x²), with the limit k of κ x, derived; scaling_second: "
            "c, fitted to κ of the limit; "
            "scaling_chi2: its χ²; scaling_deviation: the largest κ over it, less one; rate: hops "
            "per time, of both of two discs, or of each of more discs; diffusion: D/(ν ℓ²) with "
            "ν hops of a disc per time in either direction, each by ℓ; "
            "single_file: F of the mean square displacement F √t, over ℓ² in single files; "
            "density: S, the relative variance of the number of discs in a long piece of a single "
            "file; in long single files, over ℓ²: displacement, the mean square displacement of a "
            "tagged disc in the time t; file, that of a place in the order of the discs; order: "
            "the mean square of the number of places by which a disc has moved in the order; "
            "amplitude: c of 1 − κ = c σ^(2/3) ε^(1/3)/A, ε the width of the neck and A the range "
            "along the hop"
        ),
        "method": TEXT(
            "clusters: odd clusters over hops; hops: initial states on the surface of the hop; "
            "states: initial states of the invariant measure; order: by the order of the discs in "
            "a single file, with ν of the same motion; fit: to other rows; limit: the motion in "
            "the limit ε → 0; all_hops: over all hops of a disc of a file within a time; same_pair "
            "and other_pairs: its parts, with the same disc and with others"
        ),
        "time": TIME("t; for clusters, the time without a hop that ends a cluster"),
        "estimate": Column(float, "time, 1/time or none", "estimate"),
        "stderr": AS_ESTIMATE("its standard error"),
        "uncorrected": NUMBER(
            "of a coefficient by clusters: odd clusters over hops; κ is larger, because passages "
            "within one pause are merged"
        ),
        "reference": AS_ESTIMATE(
            "expected value: exact, or by the other method; for more than two discs by Monte "
            "Carlo; of κ x the limit for large x, of discs that diffuse along the channel; of κ of "
            "the limit with friction the law of x"
        ),
        "reference_stderr": AS_ESTIMATE(
            "standard error of the reference; empty if the reference is exact"
        ),
        "z": Z,
        "test": TEXT("how z was found: normal"),
        "replicas": COUNT("independent replicas; for a fit, points"),
        "events": COUNT("wall hits and disc collisions simulated for the estimate"),
    }

    @staticmethod
    def part(part, **given):
        """Return the rows of a part of the table, one of ``measure.PARTS``."""
        from twodiscs_paper.studies.passages import measure

        return measure.PARTS[part](**given)

    @staticmethod
    def rows(tables):
        """Return the rows of all parts, one part after the other, and the fits to them."""
        from twodiscs_paper.studies.passages.powers import fits

        rows = [row for part in tables.values() for row in part]
        return [*rows, *fits(rows)]


class BrownianTable(Table):
    """
    One row per quantity of two discs in Brownian dynamics: steps of equal length in a channel that
    is closed to a ring. Lengths are in units of the contact distance σ, times in steps.
    """

    columns = {
        "program": TEXT(
            "how discs move in a step. reflected: thermal velocities are drawn for each step, and "
            "collisions are elastic; kicked: the same with random times between draws, half a step "
            "on average; together: both discs are displaced, and the step is rejected if they "
            "overlap, walls fold it; confined: the same, a step into a wall is rejected too; "
            "singly: two moves of one random disc each, a move is rejected if discs overlap, walls "
            "fold it"
        ),
        "step": Column(
            float, "σ", "s, the standard deviation of a coordinate of a free disc after a step"
        ),
        "room": Column(
            float,
            "σ",
            "ε, the width of the neck; for a local exponent, the geometric mean of two; for a "
            "fitted one, the smallest",
        ),
        "neck": NUMBER("√(εσ)/s, the length of the neck over that of a step"),
        "seed": COUNT("1, 2 …: an exponent from one of the seeds; empty for all seeds together"),
        "quantity": TEXT(
            "coefficient: κ, the rate of passages over that of crossings in transition state "
            "theory, s ε²/(√π V) in one direction; crossing_rate: of all crossings, over the same; "
            "passage_time: mean time from the largest separation to the largest one on the other "
            "side; first_time: to the first crossing; first_exponent: of first_time, as a power of "
            "ε, from two neighbouring widths; local_exponent: of the time between passages "
            "over V, as a power of ε, from two neighbouring widths; exponent: the same, fitted "
            "where the neck is at least 8 steps or at most 1/8 of a step. V is the volume of the "
            "allowed positions"
        ),
        "method": TEXT(
            "crossings: random crossings, followed in both directions of time until the discs are "
            "too far apart to touch; passages: pairs from their largest separation to that on the "
            "other side"
        ),
        "estimate": Column(float, "step or none", "estimate"),
        "stderr": AS_ESTIMATE("its standard error"),
        "diffusive": NUMBER(
            "the same of a separation that diffuses, by the moves that a program accepts: κ, "
            "first_time, an exponent"
        ),
        "reference": AS_ESTIMATE(
            "expected value: 1 for crossings of reflected discs, by crossings for passages, of "
            "reflected discs for kicked ones; for a fitted exponent of long necks diffusive, if "
            "heights diffuse as slowly as the separation, to first order in ε/σ"
        ),
        "reference_stderr": AS_ESTIMATE(
            "standard error of the reference; empty if the reference is exact"
        ),
        "z": Z,
        "seeds_z": NUMBER("difference of two seeds in standard errors"),
        "samples": COUNT("crossings, or pairs; for an exponent, points"),
        "steps": COUNT("steps, or moves of one disc, simulated for the estimate"),
    }

    @staticmethod
    def part(seeds, crossings, passages):
        """Return the rows of a long run (see ``brownian.counted``)."""
        from twodiscs_paper.studies.passages import brownian

        return brownian.rows(brownian.counted(seeds, crossings, passages))


#: Moments of inertia of rough discs, for the last hop of the first box and for
#: all others.
INERTIAS, OTHERS = [0.1, 0.25, 0.5, 1.0], [0.5]

#: The radii over the height of the box at which discs of a long single file cannot pass.
BLOCKED_RADII = (0.28, 0.27, 0.3)


def _parts(configuration):
    """Return {name: parameters} of the parts; each part has its own random streams."""
    parts, seed = {}, {"seed": configuration.seed}
    events = {"events": scaled(configuration.study_events, 800, 2**19, 2**25)}
    for scene in configuration.plain:
        own = {"name": scene.name, "box": scene.box.parameters()} | events | seed
        first = scene == configuration.main
        hops = [hop for hop in HOPS if scene.box.threshold(hop) in scene.box.thresholds]
        for hop in hops:
            inertias = INERTIAS if first and hop == hops[-1] else OTHERS
            near = {"part": "near_threshold", "hop": hop, "inertias": inertias}
            parts[f"near_threshold_{scene.name}_{hop}"] = near | own
        if first and scene.box.fits(scene.box.height / 4):
            own_parts = ("on_ring", "with_friction")
            parts |= {part: {"part": part} | own for part in own_parts}
        blocked = [part * scene.box.height for part in BLOCKED_RADII]
        if first and all(scene.box.fits(radius) for radius in blocked):
            alone = {"name": scene.name, "box": scene.box.parameters(), "blocked": blocked} | seed
            parts["in_long_file"] = {"part": "in_long_file"} | alone
    return parts | {part: {"part": part} | seed for part in ("in_the_limit", "in_pore")}


STUDY = Study(
    "passages",
    builds="which hops are passages, and diffusion by them",
    tables=(PassagesTable,),
    long_runs=(BrownianTable,),
    seconds=70.0,
    order=6,
    figures={
        "passages": Figure(
            "Hops that are passages",
            DYNAMICS,
            """Hops near the radius r_c at which they become blocked, at distances
            δ = (r_c − r)/r_c. (a) Transmission coefficient κ(t): the correlation between the order
            of the discs at a time t after a hop and the direction of the hop, for smooth discs
            (circles) and rough ones (squares). It starts with the exact slope −2p(0⁺) (dashed, in
            the limit δ → 0). If hops are rare it has a plateau, which falls as passages follow one
            another (lines: by κ from clusters). (b) Exact mean time τ between hops (lines) and mean
            time τ/κ between passages (symbols). Error bars are one standard error.""",
            tables=("passages",),
            long_runs={"kept": "paper/long_run/passages/passages.csv"},
        ),
        "transmission": Figure(
            "Passages near the threshold",
            DYNAMICS,
            """Transmission coefficient κ near the radius r_c at which hops become blocked, at
            distances δ = (r_c − r)/r_c. (a) Smooth discs: 1 − κ over ∛(εσ²)/A, with the range A
            along the hop, σ = 2r and the room ε that the discs leave in the neck. Full symbols are
            long runs. The star is the limit c, computed for δ → 0. The grey line is fitted to the
            long run at h/4, from 2⁻¹² on. (b) Rough discs, with moments of inertia I in units of
            mr². Powers in the legend are fitted to the last distances. (c), (d) Residuals z in
            standard errors: of the slope of κ(t) at 0 from its exact value, and between two
            estimators of κ. Error bars are one standard error.""",
            tables=("passages",),
            long_runs={"kept": "paper/long_run/passages/passages.csv"},
        ),
        "friction": Figure(
            "Passages with friction",
            DYNAMICS,
            """Velocities of both discs are drawn anew at random times of the rate γ (friction). (a)
            The fraction κ of hops that are passages, near the radius r_c = h/4. The abscissa is
            x = γ√(εσ), with the room ε = h − 4r that the discs leave in the neck and σ = 2r.
            Crosses are the limit of a narrow neck. Dashed: 1 of one flight, and 3/(4x) of
            diffusion. Line: 1/κ = 4x/3 + 1/(1 + bx + cx²), with b = 4/3 − √2π/5 and c = 0.055. (b)
            The local power of the distance r_c − r with which the time τ/κ between passages grows.
            Dashed: the powers of diffusion and of one flight. Full symbols are a long run. Error
            bars are one standard error.""",
            tables=("passages",),
            long_runs={"kept": "paper/long_run/passages/passages.csv"},
        ),
        "brownian": Figure(
            "Passages in Brownian dynamics",
            DYNAMICS,
            """Two discs in Brownian dynamics, in a channel of the height 2σ + ε that is closed to a
            ring of the length 3σ. In a step a coordinate of a free disc moves by a normal deviate
            of the standard deviation s. The abscissa is the length √(εσ) of the neck over s.
            Reflected discs fly through the step and collide elastically. Steps of both discs or of
            one are rejected if the discs overlap; walls reflect them, or also reject them. (a) κ,
            the rate of passages over that of crossings in transition state theory: by crossings
            that are followed both ways (open), and by first passages (dots). Dashed: 1, and √(2/π)
            s/√(εσ) of diffusion. (b) The local power of ε with which the mean time between passages
            over the volume grows. Dashed: −3/2 of diffusion, −2 of flight, −5/2 and −7/2 of
            rejected moves of one disc and of both, and 0 of a time that stays finite. Lines: the
            law of rejected moves, without a parameter. Error bars are one standard error.""",
            long_runs={"brownian": "paper/long_run/brownian/brownian.csv"},
        ),
        "diffusion": Figure(
            "Diffusion by hops",
            DYNAMICS,
            """Coefficient D of diffusion on a ring over that of a random walk with ν hops of a disc
            per time in either direction, each by ℓ (dashed), at distances δ = (r_c − r)/r_c from
            the radius r_c at which hops become blocked. (a) Two discs, by correlations of hops
            (open symbols) and by displacements (full symbols). (b) Single files in long runs, by
            the order of the discs: of four and eight discs (full symbols), and long ones (open
            symbols). (c) Residuals z in standard errors, from the exact rate, between two
            estimators, or of F in ⟨x²⟩ = F√t from theory. Error bars are one standard error.""",
            tables=("passages",),
            long_runs={
                name: f"paper/long_run/{name}/passages.csv" for name in ("files", "displacements")
            },
        ),
        "files": Figure(
            "Displacements in single files",
            DYNAMICS,
            """Mean square displacement of a tagged disc in a long single file on a ring. (a) Files
            that are blocked (r = 0.28 h, full symbols) and open (δ = 1/8, open symbols), in units
            of ℓ², h and the thermal speed. Black lines are the theory of blocked ones, without a
            free parameter: sound of smooth discs, until it has gone around half of the ring, and
            damped sound with friction. Rough discs (I = 1/2) have no such line. Dashes are also
            measured: the motion of the places plus the steps of the discs from place to place. (b)
            Open files with friction: displacements in units of F√t×, at times over t× = (F/2D)²,
            where single file and hops contribute equally. Error bars are one standard error.""",
            long_runs={"displacements": "paper/long_run/displacements/passages.csv"},
        ),
    },
    parts=_parts,
    checked=True,
)
