"use strict";
// The page: sliders, the drawing, the table and the two plots.

const DATA = JSON.parse(document.getElementById("data").textContent);

/** What may stand behind # in the address: #width=3&height=1&radius=0.24&seed=7&runs=5000, where
 *  counting ends after so many runs. */
const ASKED = new URLSearchParams(location.hash.slice(1));
const SEED = Number(ASKED.get("seed") ?? DATA.seed);
const MOST_RUNS = Number(ASKED.get("runs") ?? Infinity);

/** Units per second that the drawn pair moves. */
const SPEED = 0.6;

/** Counting takes so many milliseconds of a frame, of the 16 that there are on most screens. */
const SHARE = 9;

/** Events between two looks at the clock, and looks in a frame at most. */
const CHUNK = 2000, CHUNKS = 200;

/** Milliseconds between two renewals of the numbers: they are to be read. */
const RENEWED = 250;

/** Decades of mean times that are shown, in units. */
const SHOWN_TIMES = [0.001, 1000];

/** Radii of a curve in each regime. */
const DENSE = 90;

const NAMES = {
  vertical_hop: "vertical hops",
  horizontal_hop: "horizontal hops",
  disc_collision: "disc collisions",
  any_wall: "wall hits",
};
const GLYPHS = { o: "●", s: "■", "^": "▲", P: "✚", D: "◆", v: "▼" };

const at = (id) => document.getElementById(id);
const colour = (event) => DATA.looks[event][0];
const key = (event) =>
  `<span class="key" style="color: ${colour(event)}">${GLYPHS[DATA.looks[event][1]]}</span>`;

// All is computed in a unit of length in which the box is of order one, and multiplied where it is
// printed. That is the unit of time, too, for the speed is 1.
let unit;

/** The power of ten next to the shorter side of a box. */
const unitOf = ({ width, height }) => (
  Number(`1e${Math.round(Math.log10(Math.min(width, height)))}`));

/** A length or a time in units, without the last bits that the division adds. */
const inUnits = (value) => Number((value / unit).toPrecision(15));

const state = { paused: matchMedia("(prefers-reduced-motion: reduce)").matches };

let runs; // the statistics of the scene
let drawn; // the run that is shown: {pair, time, trail, flash}

// Controls -----------------------------------------------------------------------------------

/** The largest radius of the slider: a little below where the discs jam. */
const lastRadius = () => Math.floor(999 * largestRadius(state.width, state.height)) / 1000;

/** Take a box and its unit; the sliders reach the boxes of the build that have the same one. */
function choose(box) {
  unit = unitOf(box);
  const alike = [box, ...DATA.scenes.filter((scene) => unitOf(scene) === unit)];
  for (const [side, low, high] of [["width", 0.5, 3], ["height", 0.5, 2]]) {
    const sides = alike.map((scene) => inUnits(scene[side]));
    at(side).min = Math.min(low, ...sides);
    at(side).max = Math.max(high, ...sides);
    state[side] = sides[0];
  }
}

function prepareControls() {
  const first = DATA.scenes[0] ?? { width: 1.5, height: 1 };
  choose({
    width: Number(ASKED.get("width") ?? first.width),
    height: Number(ASKED.get("height") ?? first.height),
  });
  // Discs of this radius can hop either way, whatever the box.
  const usual = (Math.min(state.width, state.height) / 5).toFixed(3);
  state.radius = ASKED.has("radius") ? inUnits(ASKED.get("radius")) : Number(usual);
  at("radius").min = 0.01;
  for (const name of ["width", "height", "radius"]) {
    at(name).addEventListener("input", () => {
      state[name] = Number(at(name).value);
      changed();
    });
  }
  for (const scene of DATA.scenes) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = `${short(scene.width, 12)} × ${short(scene.height, 12)}`;
    button.title = `The box of the scene ${scene.name}, with the points of its tables`;
    button.addEventListener("click", () => {
      choose(scene);
      changed();
    });
    at("buttons").append(button);
  }
  at("pause").addEventListener("click", () => {
    state.paused = !state.paused;
    showPause();
  });
  at("hop").addEventListener("change", renew);
}

function showPause() {
  at("pause").textContent = state.paused ? "Run" : "Pause";
}

function showControls() {
  at("radius").max = lastRadius();
  for (const name of ["width", "height", "radius"]) {
    const shown = short(unit * state[name], 12);
    at(name).value = state[name];
    at(name).ariaValueText = shown;
    at(name).nextElementSibling.value = shown;
  }
}

/** Begin anew: the box or the radius is another one. */
function changed() {
  state.radius = Math.min(Math.max(state.radius, 0.01), lastRadius());
  showControls();
  at("duration").textContent = short(unit * DURATION);
  runs = new Runs(state.width, state.height, state.radius, SEED);
  show(runs.current);
  const possible = [0, 1].filter((hop) => runs.exact.times[COUNTED[hop]] !== null);
  if (possible.length === 1) at("hop").value = possible[0];
  timesPlot.setData(exactCurves());
  at("points").textContent = builtScene()
    ? "small symbols are points of this build, filled by molecular dynamics, open by Monte Carlo."
    : "the build has no points of this box.";
  renew();
  draw();
}

// The drawing --------------------------------------------------------------------------------

function show(initial) {
  const pair = new Pair(state.width, state.height, state.radius, initial);
  drawn = { pair, time: 0, trail: [[0, pair.x1, pair.y1, pair.x2, pair.y2]], flash: null };
}

/** Move the drawn pair by some time; at the end of its run another one follows. */
function move(time) {
  const { pair } = drawn;
  while (time > 0) {
    pair.step(time);
    time -= pair.flight;
    drawn.time += pair.flight;
    drawn.trail.push([drawn.time, pair.x1, pair.y1, pair.x2, pair.y2]);
    if (pair.vertical >= 0) drawn.flash = { name: "vertical hop", since: drawn.time };
    if (pair.horizontal >= 0) drawn.flash = { name: "horizontal hop", since: drawn.time };
  }
  while (drawn.trail[0][0] < drawn.time - 1.5) drawn.trail.shift();
  if (drawn.time >= DURATION) show(runs.shown ?? runs.current);
}

function draw() {
  const canvas = at("box"), context = canvas.getContext("2d");
  const density = devicePixelRatio || 1;
  const [wide, high] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = wide * density;
  canvas.height = high * density;
  const scale = Math.min((wide - 8) / state.width, (high - 8) / state.height);
  context.setTransform(scale * density, 0, 0, -scale * density, canvas.width / 2, canvas.height / 2);
  const line = 1 / scale;
  const { pair, trail, flash, time } = drawn;
  const discs = [
    [pair.x1, pair.y1, colour("vertical_hop"), "1"],
    [pair.x2, pair.y2, colour("horizontal_hop"), "2"],
  ];

  context.fillStyle = "#f7f7f7";
  context.fillRect(-state.width / 2, -state.height / 2, state.width, state.height);
  context.lineWidth = 3 * line;
  context.strokeStyle = "#1b1b1b";
  context.strokeRect(-state.width / 2, -state.height / 2, state.width, state.height);

  context.lineWidth = 1.5 * line;
  for (const [disc, [, , paint]] of discs.entries()) {
    context.strokeStyle = paint;
    for (let i = 1; i < trail.length; i++) {
      context.globalAlpha = 0.8 * Math.max(0, 1 - (time - trail[i][0]) / 1.5);
      context.beginPath();
      context.moveTo(trail[i - 1][1 + 2 * disc], trail[i - 1][2 + 2 * disc]);
      context.lineTo(trail[i][1 + 2 * disc], trail[i][2 + 2 * disc]);
      context.stroke();
    }
  }
  for (const [x, y, paint] of discs) {
    context.globalAlpha = 0.55;
    context.fillStyle = context.strokeStyle = paint;
    context.beginPath();
    context.arc(x, y, state.radius, 0, 2 * Math.PI);
    context.fill();
    context.globalAlpha = 1;
    context.stroke();
  }

  context.setTransform(density, 0, 0, density, 0, 0);
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillStyle = "#000";
  context.font = "600 14px system-ui, sans-serif";
  const pixels = (x, y) => [wide / 2 + scale * x, high / 2 - scale * y];
  if (scale * state.radius > 8) {
    for (const [x, y, , name] of discs) context.fillText(name, ...pixels(x, y));
  }
  const age = flash ? time - flash.since : Infinity;
  if (age < 0.35) {
    // The line on which both centres were, drawn where they are now.
    const upright = flash.name === "horizontal hop";
    const x = (pair.x1 + pair.x2) / 2, y = (pair.y1 + pair.y2) / 2;
    const ends = upright
      ? [[x, -state.height / 2], [x, state.height / 2]]
      : [[-state.width / 2, y], [state.width / 2, y]];
    context.globalAlpha = 1 - age / 0.35;
    context.setLineDash([6, 4]);
    context.lineWidth = 1.5;
    context.strokeStyle = "#000";
    context.beginPath();
    context.moveTo(...pixels(...ends[0]));
    context.lineTo(...pixels(...ends[1]));
    context.stroke();
    context.setLineDash([]);
    const above = high / 2 - (scale * state.height) / 2 + 16;
    context.strokeStyle = "#fff";
    context.lineWidth = 4;
    context.strokeText(flash.name, wide / 2, above);
    context.fillText(flash.name, wide / 2, above);
    context.globalAlpha = 1;
  }
}

// The table ----------------------------------------------------------------------------------

const whole = (number) => number.toLocaleString("en").replaceAll(",", "\u202f");

const isUsual = (number) => number === 0 || (number >= 1e-3 && number < 1e5);

const exponential = (number, digits) => number.toExponential(digits).replace("+", "");

/** A number to some digits, without an exponent where people write none. */
function short(number, digits = 4) {
  const rounded = Number(number.toPrecision(digits));
  return isUsual(rounded) ? String(rounded) : exponential(rounded);
}

/** Numbers with as many decimals as an error leaves, of which two digits count. */
function decimals(error) {
  if (!error) return short;
  const digits = 1 - Math.floor(Math.log10(error));
  return (number) => (isUsual(number)
    ? number.toFixed(Math.max(0, digits))
    : exponential(number, Math.max(0, digits + Math.floor(Math.log10(number)))));
}

function showTable() {
  at("events").innerHTML = COUNTED.map((event, i) => {
    const { count, time, error, exact, z } = runs.measured(i);
    const decimal = decimals(error && unit * error), rounded = (units) => decimal(unit * units);
    const cells = [
      whole(count),
      time === null ? "–" : rounded(time),
      error === null ? "–" : `${((100 * error) / time).toPrecision(2)} %`,
      exact === null ? "never" : rounded(exact),
      z === null ? "–" : `${z < 0 ? "−" : "+"}${Math.abs(z).toFixed(1)}`.replace("−0.0", "+0.0"),
    ];
    const row = cells.map((cell) => `<td>${cell}</td>`).join("");
    return `<tr id="${event}"><th scope="row">${key(event)} ${NAMES[event]}</th>${row}</tr>`;
  }).join("");
  const { done, events } = runs;
  at("status").textContent = done
    ? `${whole(done)} runs of ${short(unit * DURATION)} time units, ${(events / 1e6).toFixed(1)} million events`
    : state.paused ? "Paused: press Run to count." : "";
}

// The plots ----------------------------------------------------------------------------------

/** [radii, mean times of each event]: dense where curves bend, towards the ends of each regime. */
function exactCurves() {
  const ends = thresholds(state.width, state.height).map(([radius]) => radius);
  const edges = [0, ...ends, largestRadius(state.width, state.height)];
  const radii = edges.slice(1).flatMap((high, i) => Array.from({ length: DENSE }, (_, j) =>
    edges[i] + (high - edges[i]) * Math.sin((Math.PI / 2) * ((j + 0.5) / DENSE)) ** 2));
  const computed = radii.map((radius) => [radius, exact(state.width, state.height, radius)]);
  const kept = computed.filter(([, numbers]) => numbers !== null);
  return [
    kept.map(([radius]) => radius),
    ...COUNTED.map((event) => kept.map(([, { times }]) => times[event])),
  ];
}

const MARKERS = {
  o: (c, x, y, s) => c.arc(x, y, s, 0, 2 * Math.PI),
  s: (c, x, y, s) => c.rect(x - 0.85 * s, y - 0.85 * s, 1.7 * s, 1.7 * s),
  "^": (c, x, y, s) => polygon(c, x, y, [[0, -1.15], [1, 0.75], [-1, 0.75]], s),
  v: (c, x, y, s) => polygon(c, x, y, [[0, 1.15], [1, -0.75], [-1, -0.75]], s),
  D: (c, x, y, s) => polygon(c, x, y, [[0, -1.2], [1.2, 0], [0, 1.2], [-1.2, 0]], s),
  P: (c, x, y, s) => polygon(c, x, y, [
    [-0.4, -1.1], [0.4, -1.1], [0.4, -0.4], [1.1, -0.4], [1.1, 0.4], [0.4, 0.4],
    [0.4, 1.1], [-0.4, 1.1], [-0.4, 0.4], [-1.1, 0.4], [-1.1, -0.4], [-0.4, -0.4],
  ], s),
};

function polygon(context, x, y, corners, size) {
  for (const [u, v] of corners) context.lineTo(x + u * size, y + v * size);
  context.closePath();
}

/** The tables of the build for the box of the sliders, if it is one of its scenes. */
const builtScene = () => DATA.scenes.find(
  ({ width, height }) => inUnits(width) === state.width && inUnits(height) === state.height);

/** Draw points with errors on the curves: those of the build, and what this page has counted. */
function drawPoints(plot) {
  const { ctx: context, bbox } = plot;
  const pixel = devicePixelRatio || 1;
  const x = (value) => plot.valToPos(value, "x", true);
  const y = (value) => plot.valToPos(value, "y", true);
  const point = (event, [radius, time, error], size, filled) => {
    context.strokeStyle = colour(event);
    context.fillStyle = filled ? colour(event) : "rgba(255, 255, 255, 0.6)";
    context.beginPath();
    MARKERS[DATA.looks[event][1]](context, x(radius), y(time), size * pixel);
    context.fill();
    context.stroke();
    if (error && error < time) {
      context.beginPath();
      context.moveTo(x(radius), y(time - error));
      context.lineTo(x(radius), y(time + error));
      context.stroke();
    }
  };
  context.save();
  context.beginPath();
  context.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  context.clip();

  context.strokeStyle = "#8a8a8a";
  context.fillStyle = "#444";
  context.lineWidth = pixel;
  context.font = `${12 * pixel}px system-ui, sans-serif`;
  context.textAlign = "right";
  context.textBaseline = "top";
  context.setLineDash([4 * pixel, 4 * pixel]);
  for (const [radius, name] of thresholds(state.width, state.height)) {
    context.beginPath();
    context.moveTo(x(radius), bbox.top);
    context.lineTo(x(radius), bbox.top + bbox.height);
    context.stroke();
    context.fillText(`${name} `, x(radius), bbox.top + 3 * pixel);
  }
  context.setLineDash([]);
  const built = builtScene();
  for (const event of COUNTED) {
    const { monte_carlo, dynamics } = built?.points[event] ?? { monte_carlo: [], dynamics: [] };
    for (const row of monte_carlo) point(event, row.map(inUnits), 4.2, false);
    for (const row of dynamics) point(event, row.map(inUnits), 1.9, true);
  }
  context.lineWidth = 2.5 * pixel;
  COUNTED.forEach((event, i) => {
    const { time, error } = runs.measured(i);
    if (time !== null) point(event, [state.radius, time, error], 7, false);
  });
  context.restore();
}

const AXIS = {
  font: "13px system-ui, sans-serif",
  grid: { stroke: "#eee", width: 1 },
  labelFont: "14px system-ui, sans-serif",
  labelGap: 2,
  labelSize: 22,
  values: (plot, ticks) => ticks.map((tick) => (tick === null ? "" : short(tick))),
};
const multiplied = (plot, ticks) => AXIS.values(plot, ticks.map((tick) => tick && unit * tick));
const COMMON = {
  cursor: { show: false },
  height: 320,
  legend: { show: false },
  padding: [10, 12, 0, 0],
  pxAlign: false,
};

const timesPlot = new uPlot({
  ...COMMON,
  width: 300,
  scales: {
    x: { time: false, range: () => [0, 1.03 * largestRadius(state.width, state.height)] },
    y: { distr: 3, range: () => SHOWN_TIMES },
  },
  axes: [
    { ...AXIS, values: multiplied, label: "radius r (length)", size: 32 },
    { ...AXIS, values: multiplied, label: "mean time τ (length/speed)", size: 54 },
  ],
  series: [{}, ...COUNTED.map((event) => (
    { stroke: colour(event), width: 2, points: { show: false } }))],
  hooks: { draw: [drawPoints] },
}, [[], ...COUNTED.map(() => [])], at("times"));

const intervalsPlot = new uPlot({
  ...COMMON,
  width: 300,
  scales: {
    x: { time: false, range: () => [0, REACH] },
    y: { distr: 3, range: (plot, low, high) => [1e-3, Math.max(3, 1.5 * (high ?? 0))] },
  },
  axes: [
    { ...AXIS, label: "interval t/τ, τ the exact mean time", size: 32 },
    { ...AXIS, label: "probability density × τ", size: 54 },
  ],
  series: [
    {},
    {
      stroke: () => colour(COUNTED[at("hop").value]),
      fill: () => `${colour(COUNTED[at("hop").value])}40`,
      width: 1.5,
      paths: uPlot.paths.bars({ size: [1, Infinity] }),
      points: { show: false },
    },
    { stroke: "#000", width: 2, dash: [7, 4], points: { show: false } },
  ],
}, [[], [], []], at("intervals"));

function showIntervals() {
  const hop = Number(at("hop").value), event = COUNTED[hop];
  const { bins, mean, total } = runs.histograms[hop];
  const width = REACH / BINS;
  const centres = Array.from(bins, (_, i) => (i + 0.5) * width);
  const density = Array.from(bins, (count) => (count ? count / (total * width) : null));
  intervalsPlot.setData([
    centres, density, centres.map((x) => (mean === null ? null : Math.exp(-x))),
  ]);
  at("said").textContent = mean === null
    ? `In this box discs of this radius make no ${NAMES[event]}.`
    : `Bars are ${whole(total)} intervals, drawn without errors; the dashed line is the exponential`
      + ` of the exact mean, τ = ${short(unit * mean)}, which independent hops would follow.`;
}

/** Renew all numbers. */
function renew() {
  showTable();
  showIntervals();
  timesPlot.redraw();
}

function prepareTexts() {
  at("enough").textContent = ENOUGH;
  at("boxes").textContent = DATA.scenes.length ? "Boxes of the build:" : "";
  const named = COUNTED.map((event) => `<span class="name">${key(event)} ${NAMES[event]}</span>`);
  at("legend").innerHTML = named.join(" ");
}

// Time ---------------------------------------------------------------------------------------

let before = null, renewed = 0;

function frame(now) {
  if (!state.paused) {
    // After a pause of the browser's own, in a hidden page, nothing is made up for.
    move((SPEED * Math.min(now - (before ?? now), 50)) / 1000);
    const begun = performance.now();
    for (let i = 0; i < CHUNKS && performance.now() - begun < SHARE; i++) runs.advance(CHUNK, MOST_RUNS);
    draw();
    if (now - renewed > RENEWED) {
      renew();
      renewed = now;
    }
  }
  before = now;
  requestAnimationFrame(frame);
}

function fit() {
  for (const plot of [timesPlot, intervalsPlot]) {
    plot.setSize({ width: plot.root.parentElement.clientWidth, height: COMMON.height });
  }
  draw();
}

prepareControls();
prepareTexts();
changed();
showPause();
fit();
addEventListener("resize", fit);
requestAnimationFrame(frame);
