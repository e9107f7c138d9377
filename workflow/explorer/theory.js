"use strict";
// Exact volume, areas and mean times of two equal discs, as in theory/plain.py and weighted.py.
//
// Lengths are integers (BigInt) in units of 2^-k, so that differences with cancellation are
// exact and rounded once. Volume and areas are sums of positive terms over the arc
// (u, v) = σ (cos θ, sin θ) within [0, A] × [0, B], σ = 2r. A and B are the largest separations of
// the centres: w − 2r and h − 2r, or half a side on a periodic axis. In a field B is at most
// E/g, the height at which one disc has all the energy. The effects of a scene are
// {periodic: "", "x", "y" or "xy", field}. Friction changes no mean time.

const COUNTED = ["vertical_hop", "horizontal_hop", "disc_collision", "any_wall"];

/** Triples [t, 1 − t, weight] of the Gauss–Legendre rule on [0, 1]. */
function gaussLegendre(order) {
  const rule = [];
  for (let i = 0; i < order; i++) {
    let x = Math.cos((Math.PI * (i + 0.75)) / (order + 0.5));
    let slope;
    for (let step = 0; step < 8; step++) {
      let last = 1, p = x;
      for (let k = 2; k <= order; k++) [last, p] = [p, ((2 * k - 1) * x * p - (k - 1) * last) / k];
      slope = (order * (last - x * p)) / (1 - x * x);
      x -= p / slope;
    }
    rule.push([(1 - x) / 2, (1 + x) / 2, 1 / ((1 - x * x) * slope ** 2)]);
  }
  return rule;
}

// Without a field the integrands are trigonometric polynomials of degree 4 at most.
const RULE = gaussLegendre(16);

// In a field they have half-integer powers at their ends: the rule of Takahasi and Mori.
const SINGULAR = Array.from({ length: 53 }, (_, i) => {
  const x = (i - 26) / 8, y = Math.PI * Math.sinh(x);
  const t = 1 / (1 + Math.exp(-y)), rest = 1 / (1 + Math.exp(y));
  return [t, rest, (Math.PI / 8) * Math.cosh(x) * t * rest];
});

/** The mean size c_D of a component of the uniform unit vector in D dimensions. */
const SIZES = { 2: 2 / Math.PI, 3: 1 / 2, 4: 4 / (3 * Math.PI) };

const least = (a, b) => (a < b ? a : b);

/** A, B and σ, and the ranges of a centre between walls, as integers in units of 2^-k; `float`
 *  rounds a product of `power` lengths. */
function lengths(width, height, radius, { periodic = "", field = 0 } = {}) {
  const sides = [width / 2, height / 2, radius, Math.min(0.5 / field, height)];
  let k = 0;
  while (!sides.every((side) => Number.isInteger(side * 2 ** k))) k++;
  const [w, h, r, highest] = sides.map((side) => BigInt(side * 2 ** k));
  const float = (value, power) => Number(value) / 2 ** (power * k);
  const ranges = [2n * (w - r), 2n * (h - r)];
  return {
    A: periodic.includes("x") ? w : ranges[0],
    B: periodic.includes("y") ? h : least(ranges[1], highest),
    sigma: 2n * r,
    ranges,
    float,
  };
}

/** Whether both discs fit and can move. */
function fits({ A, B, sigma, ranges }) {
  return ranges.every((range) => range > 0n) && A * A + B * B > sigma * sigma;
}

/** Return functions of z = B − v, for the separation v along y, of discs between walls in a `field`.
 *
 * `common(z, n)` is the integral of (1 − U/E)^p over the common motion of both discs, p = n/2 − 1;
 * `ends(z, n)` is the sum of (1 − U/E)^p with one disc on the bottom and with one at the top. */
function densities({ B, ranges, float }, field) {
  const below = ranges[1] > B ? 0 : 1 - 2 * field * float(B, 1); // 1 − U/E at v = B on the bottom
  const more = float(ranges[1] - B, 1);
  const energies = (z) => {
    const bottom = Math.max(below + 2 * field * z, 0), open = Math.min(more + z, bottom / (4 * field));
    return { bottom, open, top: Math.max(bottom - 4 * field * (more + z), 0) };
  };
  const common = (z, n) => {
    const { bottom, open, top } = energies(z), a = Math.sqrt(bottom), b = Math.sqrt(top);
    // (aⁿ − bⁿ)/(2gn), where a² − b² is 4g times the open length.
    let sum = 0;
    for (let j = 0; j < n; j++) sum += a ** (n - 1 - j) * b ** j;
    return a > 0 ? (2 * open * sum) / ((a + b) * n) : 0;
  };
  const ends = (z, n) => {
    const { bottom, top } = energies(z), p = n / 2 - 1;
    return bottom ** p + (top > 0 ? top ** p : 0);
  };
  return { common, ends };
}

/** Volume and areas for the `lengths` of a box in which the discs fit, in length⁴ and length³. */
function measures(given, { periodic = "", field = 0 } = {}) {
  const { A, B, sigma, ranges, float } = given;
  const square = sigma * sigma;
  // A point on the arc has the coordinate u², which falls from `start` (at β) to `stop` (at α).
  const start = least(A, sigma) ** 2n;
  const stop = square - least(B, sigma) ** 2n;

  function angle(first, second) {
    if (first === second) return 0;
    const [u1, v1, u2, v2] = [first, square - first, second, square - second].map(
      (value) => Math.sqrt(float(value, 2)));
    // u1 v2 − u2 v1, without cancellation.
    const cross = float(square * (first - second), 4) / (u1 * v2 + u2 * v1);
    return Math.atan2(cross, u1 * u2 + v1 * v2);
  }

  const [a, b, s] = [A, B, sigma].map((value) => float(value, 1));
  const beyondX = Math.max(float(A - sigma, 1), 0);
  const beyondY = Math.max(float(B - sigma, 1), 0);
  const beta = angle(square, start);
  const alphaLeft = angle(stop, 0n); // π/2 − α
  const turn = angle(start, stop);

  // Along x, as functions of x = A − u: the density of the separation and its integral from u to A.
  const [ringX, ringY] = [..."xy"].map((axis) => periodic.includes(axis));
  const densityX = (x) => (ringX ? 2 * a : x), outerX = (x) => (ringX ? 2 * a * x : (x * x) / 2);
  const { common, ends } = densities(given, field);
  const densityY = (y, n) => (ringY ? 2 * b : common(y, n));
  // The powers n of (1 − U/E)^(n/2 − 1): D for the volume and D + 1 for areas.
  const n = 4 - periodic.length;
  let volume = 0, disc = 0, right = 0, walls = 0, above = 0;

  function add(y, outer, length) {
    volume += 4 * length * densityY(y, n) * outer;
    walls += 4 * length * (ringY ? 0 : ends(y, n + 1)) * outer;
  }

  // Where the upper disc at the top leaves no energy, integrands in a field are not analytic.
  const kink = field ? 2 * float(ranges[1], 1) - 0.5 / field : 0;
  const within = (value, end) => Math.min(Math.max(value, 0), end);
  const pieces = (cut, end) => [[0, cut], [cut, end]].filter(([low, high]) => low < high);
  const rule = field ? SINGULAR : RULE;
  for (const [low, high] of pieces(within(Math.asin(within(kink / s, 1)) - beta, turn), turn)) {
    for (const [t, rest, part] of rule) {
      const after = low + t * (high - low), before = turn - high + rest * (high - low);
      const weight = part * (high - low) * s;
      // A − σ cos θ and B − σ sin θ, each as a sum of positive terms.
      const x = beyondX + 2 * s * Math.sin(after / 2) * Math.sin(beta + after / 2);
      const y = beyondY + 2 * s * Math.sin(before / 2) * Math.sin(alphaLeft + before / 2);
      const length = weight * Math.sin(alphaLeft + before), area = 2 * weight * densityY(y, n + 1);
      add(y, outerX(x), length);
      disc += area * densityX(x);
      right += area * x * Math.sin(alphaLeft + before);
    }
  }
  // Separations v > σ: the discs do not collide.
  for (const [low, high] of pieces(within(b - kink, beyondY), beyondY)) {
    for (const [t, , part] of rule) {
      const y = low + t * (high - low), length = part * (high - low);
      add(y, outerX(a), length);
      above += 2 * length * densityY(y, n + 1);
    }
  }
  right += a * above;
  return {
    volume,
    areas: {
      vertical_hop: ringY ? 0 : 2 * Math.SQRT2 * densityY(b, n + 1) * outerX(beyondX),
      horizontal_hop: ringX ? 0 : Math.SQRT2 * a * above,
      disc_collision: 2 * Math.SQRT2 * disc,
      any_wall: (ringX ? 0 : 4 * right) + walls,
    },
  };
}

/** {volume, areas, times} of a scene, null if the discs do not fit; its keys are COUNTED.
 *
 * A time is null if the event is impossible; hops and wall hits need walls along their axis. */
function exact(width, height, radius, effects = {}) {
  const given = lengths(width, height, radius, effects);
  if (!fits(given)) return null;
  const { volume, areas } = measures(given, effects);
  const times = {};
  for (const event of COUNTED) {
    const ways = event.endsWith("_hop") ? 2 : 1;
    const rate = ((ways / 2) * SIZES[4 - (effects.periodic ?? "").length] * areas[event]) / volume;
    times[event] = areas[event] ? 1 / rate : null;
  }
  return { volume, areas, times };
}

/** The radius at which two discs just fit: they jam along a diagonal, or span a side, or cannot
 *  leave the bottom in a field. */
function largestRadius(width, height, { periodic = "", field = 0 } = {}) {
  // Σ (side − 2r)² over walls + Σ fixed² = (2r)², `fixed` are other ends of the separation.
  const jammed = (walls, fixed) => {
    const squares = [...walls, ...fixed].reduce((sum, length) => sum + length ** 2, 0);
    if (walls.length < 2) return walls.length ? squares / (4 * walls[0]) : Math.sqrt(squares) / 2;
    return (width + height - Math.sqrt(2 * width) * Math.sqrt(height)) / 2;
  };
  const [ringX, ringY] = [..."xy"].map((axis) => periodic.includes(axis));
  const [walls, fixed] = ringX ? [[], [width / 2]] : [[width], []];
  return Math.min(
    Math.min(width, height) / 2,
    ringY ? jammed(walls, [...fixed, height / 2]) : jammed([...walls, height], fixed),
    jammed(walls, [...fixed, 0.5 / field]));
}

/** The radii below the largest one at which a hop becomes blocked: [[radius, its name], …]. */
function thresholds(width, height, { periodic = "", field = 0 } = {}) {
  const largest = largestRadius(width, height, { periodic, field });
  const named = new Map(periodic.includes("y") ? [] : [[width / 4, "w/4"]]);
  const [radius, name] = field * height > 1 ? [0.25 / field, "1/(4g)"] : [height / 4, "h/4"];
  if (!periodic.includes("x")) {
    named.set(radius, named.has(radius) ? `${named.get(radius)} = ${name}` : name);
  }
  return [...named].filter(([radius]) => radius < largest).sort(([a], [b]) => a - b);
}
