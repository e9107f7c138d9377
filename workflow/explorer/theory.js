"use strict";
// Exact volume, areas and mean times of two equal discs between walls, as in theory/plain.py.
//
// Lengths are integers (BigInt) in units of 2^-k, so that differences with cancellation are
// exact and rounded once. Volume and areas are sums of positive terms over the arc
// (u, v) = σ (cos θ, sin θ) within [0, A] × [0, B], A = w − 2r, B = h − 2r, σ = 2r.

const EVENTS = [
  "vertical_hop", "horizontal_hop", "disc_collision", "right_wall", "top_wall", "any_wall",
];

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

// The integrands are trigonometric polynomials of degree 4 over a quarter of a turn at most.
const RULE = gaussLegendre(16);

const least = (a, b) => (a < b ? a : b);

/** A, B and σ as integers in units of 2^-k; `float` rounds a product of `power` lengths. */
function lengths(width, height, radius) {
  const sides = [width, height, radius];
  let k = 0;
  while (!sides.every((side) => Number.isInteger(side * 2 ** k))) k++;
  const [w, h, r] = sides.map((side) => BigInt(side * 2 ** k));
  const float = (value, power) => Number(value) / 2 ** (power * k);
  return { A: w - 2n * r, B: h - 2n * r, sigma: 2n * r, float };
}

/** Whether both discs fit and can move. */
function fits({ A, B, sigma }) {
  return A > 0n && B > 0n && A * A + B * B > sigma * sigma;
}

/** Volume and areas for the `lengths` of a box in which the discs fit, in length⁴ and length³. */
function measures({ A, B, sigma, float }) {
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

  let volume = a ** 2 * beyondY ** 2;
  let disc = 0;
  let right = a * beyondY ** 2;
  let top = b * beyondX ** 2;
  for (const [t, rest, part] of RULE) {
    const after = t * turn, before = rest * turn;
    const weight = part * turn * s;
    // A − σ cos θ and B − σ sin θ, each as a sum of positive terms.
    const x = beyondX + 2 * s * Math.sin(after / 2) * Math.sin(beta + after / 2);
    const y = beyondY + 2 * s * Math.sin(before / 2) * Math.sin(alphaLeft + before / 2);
    const cos = Math.sin(alphaLeft + before), sin = Math.sin(beta + after);
    const area = 2 * weight * x * y;
    disc += area;
    volume += area * x * cos;
    right += area * cos;
    top += area * sin;
  }
  return {
    volume,
    areas: {
      vertical_hop: Math.SQRT2 * b * beyondX ** 2,
      horizontal_hop: Math.SQRT2 * a * beyondY ** 2,
      disc_collision: 2 * Math.SQRT2 * disc,
      right_wall: right,
      top_wall: top,
      any_wall: 4 * (right + top),
    },
  };
}

/** {volume, areas, times} of a box and a radius, null if the discs do not fit.
 *
 * Keys of areas and times are EVENTS. A time is null if the event is impossible. The time of a wall
 * is for disc 1, on the trajectories that can reach it: half of all if the discs keep their sides.
 */
function exact(width, height, radius) {
  const given = lengths(width, height, radius);
  if (!fits(given)) return null;
  const { volume, areas } = measures(given);
  const kept = { right_wall: given.B <= given.sigma, top_wall: given.A <= given.sigma };
  const times = {};
  for (const event of EVENTS) {
    const sides = event.endsWith("_hop") ? 2 : 1;
    const rate = (sides * areas[event]) / (1.5 * Math.PI * volume);
    times[event] = areas[event] ? (kept[event] ? 0.5 : 1) / rate : null;
  }
  return { volume, areas, times };
}

/** The radius at which two discs just fit: they jam along a diagonal, or span the short side. */
function largestRadius(width, height) {
  const short = Math.min(width, height), long = Math.max(width, height);
  if (long >= 2 * short) return short / 2;
  return (width + height - Math.sqrt(2 * width) * Math.sqrt(height)) / 2;
}

/** The radii below the largest one at which a hop becomes blocked: [[radius, its name], …]. */
function thresholds(width, height) {
  const largest = largestRadius(width, height);
  const named = width === height
    ? [[width / 4, "w/4 = h/4"]]
    : [[width / 4, "w/4"], [height / 4, "h/4"]];
  return named.filter(([radius]) => radius < largest).sort(([a], [b]) => a - b);
}
