"use strict";
// Two equal discs, event by event, and the statistics of many independent runs.
//
// Masses are 1 and the total energy is 1/2. Without a field the speed √(v1² + v2²) is therefore 1.
// The effects of a scene are those of theory.js and {friction}, the rate of kicks.

/** Uniform numbers in [0, 1) from a seed: xoshiro128++ of Blackman and Vigna. */
class Random {
  constructor(seed) {
    // They advise to take the state from another generator, here a mixed Weyl sequence.
    let weyl = seed >>> 0;
    this.state = Uint32Array.from({ length: 4 }, () => {
      weyl = (weyl + 0x9e3779b9) >>> 0;
      let z = weyl;
      z = Math.imul(z ^ (z >>> 16), 0x85ebca6b);
      z = Math.imul(z ^ (z >>> 13), 0xc2b2ae35);
      return z ^ (z >>> 16);
    });
  }

  bits() {
    const s = this.state;
    const turned = (x, n) => (x << n) | (x >>> (32 - n));
    const result = turned(s[0] + s[3], 7) + s[0];
    const t = s[1] << 9;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= t;
    s[3] = turned(s[3], 11);
    return result >>> 0;
  }

  uniform() {
    return ((this.bits() >>> 5) * 2 ** 26 + (this.bits() >>> 6)) * 2 ** -53;
  }

  /** Two numbers uniform in the unit disc, and the sum of their squares. */
  inDisc() {
    for (;;) {
      const x = 2 * this.uniform() - 1, y = 2 * this.uniform() - 1, square = x * x + y * y;
      if (square > 0 && square < 1) return [x, y, square];
    }
  }
}

/** Draw velocities {u1, v1, u2, v2} with this sum of squares, uniform on the sphere in the dimensions
 *  that are left if the total momentum along `periodic` axes is 0. */
function velocities(random, square, periodic) {
  // Marsaglia's method for a point on the sphere in four dimensions (1972).
  let [u1, v1, first] = random.inDisc();
  let [u2, v2, second] = random.inDisc();
  const scale = Math.sqrt((1 - first) / second);
  u2 *= scale;
  v2 *= scale;
  // The projection of an isotropic vector is isotropic.
  if (periodic.includes("x")) u1 = -(u2 = (u2 - u1) / 2);
  if (periodic.includes("y")) v1 = -(v2 = (v2 - v1) / 2);
  const factor = Math.sqrt(square / (u1 * u1 + v1 * v1 + u2 * u2 + v2 * v2));
  return { u1: u1 * factor, v1: v1 * factor, u2: u2 * factor, v2: v2 * factor };
}

/** Return a function that draws initial states from the invariant measure: centres in all of
 *  configuration space, with the density (1 − U/E)^(D/2 − 1), and their `velocities`. */
function initialStates(width, height, radius, { periodic = "", field = 0 } = {}) {
  const given = lengths(width, height, radius, { periodic, field });
  const [A, B, sigma, rangeX, rangeY] = [given.A, given.B, given.sigma, ...given.ranges].map(
    (value) => given.float(value, 1));
  const square = given.sigma ** 2n;
  // Without a field the separations (u, v) = (|x1 − x2|, |y1 − y2|) have the density
  // (A − u)(B − v) outside the arc; a periodic axis has no factor. The free part of
  // [0, A] × [0, B] fills a good part of its bounding rectangle at every radius. The sides of this
  // rectangle, exact where terms cancel near the largest radius:
  const excess = given.float(given.A ** 2n + given.B ** 2n - square, 2);
  const side = (range, other) => {
    const nearest = Math.sqrt(Math.max(given.float(square - other ** 2n, 2), 0));
    return nearest > 0 ? excess / (range + nearest) : range;
  };
  const sideX = side(A, given.B), sideY = side(B, given.A);
  const [ringX, ringY] = [..."xy"].map((axis) => periodic.includes(axis));

  return (random) => {
    const distance = (side, ring) => side * (ring ? random.uniform() : Math.sqrt(random.uniform()));
    let x, y, low, kinetic;
    // x = A − u has a density in proportion to x; u² + v² > σ² in terms of x and y.
    do {
      x = distance(sideX, ringX);
      y = distance(sideY, ringY);
      low = y * random.uniform(); // the height of the lower disc above the bottom
      kinetic = 1 - 2 * field * (B - y + 2 * low);
    } while (excess - x * (2 * A - x) - y * (2 * B - y) <= 0
      || (field && !(random.uniform() < kinetic ** (1 - periodic.length / 2)))); // false for NaN
    // For a given separation, the centre of both is uniform over the range that is left to it. Only
    // its value modulo the side matters on a periodic axis.
    const centres = (apart, middle) => {
      const both = [middle - apart / 2, middle + apart / 2];
      return random.uniform() < 0.5 ? both : both.reverse();
    };
    const middle = (range) => range * (random.uniform() - 0.5);
    const [x1, x2] = centres(A - x, middle(ringX ? width : x));
    const [y1, y2] = centres(B - y, ringY ? middle(height) : low - (rangeY - B + y) / 2);
    const seed = random.bits();
    return { x1, y1, x2, y2, ...velocities(random, kinetic, periodic), seed };
  };
}

const END = 0, WALL_X1 = 1, WALL_X2 = 2, WALL_Y1 = 3, WALL_Y2 = 4, DISC = 5;

// These are no events: the separation leaves ±half a period, or all velocities are drawn anew.
const WRAP_X = -1, WRAP_Y = -2, KICK = -3;

/** The time in which a disc reaches the wall ahead, at ±half.
 *
 * A disc that rounding has put behind it reaches it in an equally short time. For a disc at rest this
 * is infinity or NaN, and neither is less than a time. */
const wallTime = (x, u, half) => Math.abs((u > 0 ? half : -half) - x) / Math.abs(u);

/** The time in which a disc in a field reaches the first wall. The roots are taken in the forms that
 *  do not cancel. */
function fallTime(y, v, half, field) {
  const above = Math.abs(half - y), below = Math.abs(half + y);
  const left = v * v - 2 * field * above;
  if (v > 0 && left > 0) return (2 * above) / (v + Math.sqrt(left));
  const fast = Math.sqrt(v * v + 2 * field * below);
  return v > 0 ? (v + fast) / field : (2 * below) / (fast - v);
}

/** Coordinates whose separation has left ±half a `period`, with one of them moved by the period: the
 *  one that leaves both next to the origin. */
const nearer = (q1, q2, period) => {
  const move = q1 > q2 ? period : -period;
  return q1 + q2 > 0 === q1 > q2 ? [q1 - move, q2] : [q1, q2 + move];
};

/** A pair of discs in a box, whose centre is the origin. */
class Pair {
  constructor(width, height, radius, { periodic = "", field = 0, friction = 0 } = {}, initial) {
    Object.assign(this, initial, { width, height, periodic, field, friction });
    this.halfX = width / 2 - radius;
    this.halfY = height / 2 - radius;
    this.square = (2 * radius) ** 2;
    this.ringX = periodic.includes("x");
    this.ringY = periodic.includes("y");
    this.random = friction && new Random(this.seed);
    this.renewWait();
    // The time in the last flight at which y1 = y2 or x1 = x2; −1 if there is none.
    this.vertical = -1;
    this.horizontal = -1;
    this.flight = 0;
  }

  /** Draw the time to the next kick of a Poisson process. */
  renewWait() {
    this.wait = this.friction ? -Math.log(1 - this.random.uniform()) / this.friction : Infinity;
  }

  /** Fly to the next event, but no longer than `most`; return its code. `flight` is the time. */
  step(most) {
    let { x1, y1, x2, y2, u1, v1, u2, v2 } = this;
    const { halfX, halfY, ringX, ringY, field } = this;
    const dx = x1 - x2, dy = y1 - y2, du = u1 - u2, dv = v1 - v2;

    let time = most, code = END, t;
    if (this.wait < time) (time = this.wait), (code = KICK);
    if (ringX) {
      t = Math.abs((du > 0 ? this.width : -this.width) / 2 - dx) / Math.abs(du);
      if (t < time) (time = t), (code = WRAP_X);
    } else {
      t = wallTime(x1, u1, halfX);
      if (t < time) (time = t), (code = WALL_X1);
      t = wallTime(x2, u2, halfX);
      if (t < time) (time = t), (code = WALL_X2);
    }
    if (ringY) {
      t = Math.abs((dv > 0 ? this.height : -this.height) / 2 - dy) / Math.abs(dv);
      if (t < time) (time = t), (code = WRAP_Y);
    } else {
      t = field ? fallTime(y1, v1, halfY, field) : wallTime(y1, v1, halfY);
      if (t < time) (time = t), (code = WALL_Y1);
      t = field ? fallTime(y2, v2, halfY, field) : wallTime(y2, v2, halfY);
      if (t < time) (time = t), (code = WALL_Y2);
    }

    // Discs that touch collide only if they approach. The discriminant is computed as
    // a σ² − (Δx ∧ Δv)², which does not cancel in a grazing collision.
    const b = dx * du + dy * dv;
    if (b < 0) {
      const cross = dx * dv - dy * du;
      const discriminant = (du * du + dv * dv) * this.square - cross * cross;
      if (discriminant > 0) {
        t = (dx * dx + dy * dy - this.square) / (Math.sqrt(discriminant) - b);
        if (t < time) (time = t), (code = DISC); // a wall wins a tie
      }
    }
    if (time < 0) time = 0;

    const gained = field * time;
    x1 += u1 * time;
    y1 += (v1 - gained / 2) * time;
    x2 += u2 * time;
    y2 += (v2 - gained / 2) * time;
    v1 -= gained;
    v2 -= gained;
    if (code === WALL_X1) (x1 = x1 > 0 ? halfX : -halfX), (u1 = -u1);
    else if (code === WALL_X2) (x2 = x2 > 0 ? halfX : -halfX), (u2 = -u2);
    else if (code === WALL_Y1) (y1 = y1 > 0 ? halfY : -halfY), (v1 = -v1);
    else if (code === WALL_Y2) (y2 = y2 > 0 ? halfY : -halfY), (v2 = -v2);
    else if (code === DISC) {
      const nx = x1 - x2, ny = y1 - y2;
      const exchange = (nx * du + ny * dv) / (nx * nx + ny * ny);
      u1 -= exchange * nx;
      v1 -= exchange * ny;
      u2 += exchange * nx;
      v2 += exchange * ny;
    } else if (code === WRAP_X) [x1, x2] = nearer(x1, x2, this.width);
    else if (code === WRAP_Y) [y1, y2] = nearer(y1, y2, this.height);

    // A hop is a change of sign over the flight; zero counts as positive. Periodic axes have no hops.
    this.vertical = !ringY && dy < 0 !== y1 - y2 < 0 ? -dy / dv : -1;
    this.horizontal = !ringX && dx < 0 !== x1 - x2 < 0 ? -dx / du : -1;
    this.flight = time;
    this.x1 = x1;
    this.y1 = y1;
    this.x2 = x2;
    this.y2 = y2;
    this.u1 = u1;
    this.v1 = v1;
    this.u2 = u2;
    this.v2 = v2;
    this.wait -= time;
    if (code === KICK) {
      const square = u1 * u1 + v1 * v1 + u2 * u2 + v2 * v2;
      Object.assign(this, velocities(this.random, square, this.periodic));
      this.renewWait();
    }
    return code;
  }
}

/** The time in which a run counts events. */
const DURATION = 20;

/** Bins of the histogram of intervals, and its end in mean times. */
const BINS = 40, REACH = 5;

/** The fewest runs, and events, for an error. */
const ENOUGH = 100;

/** Many runs of one scene, one after the other, each from its own initial state.
 *
 * The mean count of a run over its duration is the rate, without bias, for initial states from the
 * invariant measure. Events of one run depend on each other, so errors come from the spread of the
 * counts between runs, which are independent: not from the square root of the number of events.
 *
 * An interval between hops belongs to the run in which it begins, and is followed to its end:
 * otherwise long intervals would be missing. Intervals longer than the histogram are only counted.
 */
class Runs {
  constructor(width, height, radius, seed, effects = {}) {
    this.scene = [width, height, radius, effects];
    this.random = new Random(seed);
    this.draw = initialStates(...this.scene);
    this.exact = exact(...this.scene);
    this.done = 0;
    this.events = 0;
    this.sums = new Float64Array(COUNTED.length);
    this.squares = new Float64Array(COUNTED.length);
    this.histograms = [0, 1].map((hop) => {
      const mean = this.exact.times[COUNTED[hop]];
      return { mean, end: mean ? REACH * mean : 0, bins: new Float64Array(BINS), total: 0 };
    });
    this.begin();
  }

  begin() {
    this.current = this.draw(this.random);
    this.pair = new Pair(...this.scene, this.current);
    this.time = 0;
    this.counts = new Float64Array(COUNTED.length);
    this.last = [NaN, NaN]; // the time of the last hop of each kind; NaN before the first
  }

  /** Simulate `events` events, until there are `runs` runs in all. */
  advance(events, runs = Infinity) {
    for (let i = 0; i < events && this.done < runs; i++) {
      if (this.time < DURATION) this.count();
      else if (this.isOpen(0) || this.isOpen(1)) this.follow();
      else this.finish();
    }
  }

  count() {
    const { pair, counts } = this;
    const code = pair.step(DURATION - this.time);
    if (code === DISC) counts[2]++;
    else if (code > END) counts[3]++;
    this.hop(0, pair.vertical, true);
    this.hop(1, pair.horizontal, true);
    // A run ends exactly at DURATION; roundings of its flights do not matter.
    this.time = code === END ? DURATION : this.time + pair.flight;
    if (code >= END) this.events++;
  }

  /** Whether an interval that began in this run is still incomplete and within the histogram. */
  isOpen(hop) {
    return this.time - this.last[hop] < this.histograms[hop].end;
  }

  follow() {
    const code = this.pair.step(Infinity);
    this.hop(0, this.pair.vertical, false);
    this.hop(1, this.pair.horizontal, false);
    this.time += this.pair.flight;
    if (code >= END) this.events++;
  }

  hop(hop, after, counted) {
    if (after < 0) return;
    const now = this.time + after;
    const { bins, end } = this.histograms[hop];
    const interval = now - this.last[hop];
    if (interval < end) bins[Math.floor((BINS * interval) / end)]++;
    this.last[hop] = counted ? now : NaN;
    if (counted) {
      this.counts[hop]++;
      this.histograms[hop].total++; // as many intervals begin
    }
  }

  finish() {
    this.counts.forEach((count, i) => {
      this.sums[i] += count;
      this.squares[i] += count * count;
    });
    this.done++;
    this.finished = this.current;
    this.begin();
  }

  /** {count, time, error, exact, z} of an event, by its index in COUNTED; unknown values are null.
   *  z is positive if the time is too long. */
  measured(i) {
    const n = this.done, count = this.sums[i], exact = this.exact.times[COUNTED[i]];
    const time = count ? (n * DURATION) / count : null;
    if (n < ENOUGH || count < ENOUGH) return { count, time, error: null, exact, z: null };
    const mean = count / n;
    const variance = ((this.squares[i] / n - mean * mean) * n) / (n - 1);
    const relative = Math.sqrt(variance / n) / mean;
    const z = exact && (DURATION / exact - mean) / (relative * mean);
    return { count, time, error: time * relative, exact, z };
  }
}
