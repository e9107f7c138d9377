"use strict";
// The page: sliders, the drawing, the table and the two plots.

const DATA = JSON.parse(document.getElementById("data").textContent);

/** The address holds the scene: #width=3&height=1&radius=0.24&periodic=x&friction=5. In addition,
 *  seed=7 chooses other random numbers and runs=5000 ends the counting after 5000 runs. */
const SIDES = ["width", "height"], LENGTHS = [...SIDES, "radius"], RATES = ["field", "friction"];
const NUMBERS = [...LENGTHS, ...RATES], KEYS = [...NUMBERS, "seed", "runs"];

/** Time units per second in the drawing. */
const SPEED = 0.6;

/** Milliseconds of a frame for counting; most screens have 16 per frame. */
const SHARE = 9;

/** Events between two readings of the clock, and the most readings in a frame. */
const CHUNK = 2000, CHUNKS = 200;

/** Milliseconds between two renewals of the numbers, long enough to read them. */
const RENEWED = 250;

/** The strongest effects that can be drawn, in units. */
const STRONGEST = { field: 100, friction: 300 };

/** The range of mean times in the plot, in units. */
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

/** The axes with walls that an event needs, any one of them. */
const NEEDED = { vertical_hop: "y", horizontal_hop: "x", disc_collision: "", any_wall: "xy" };

/** The events whose colours the discs have. */
const DISCS = ["vertical_hop", "horizontal_hop"];

const at = (id) => document.getElementById(id);
/** Blue of figures on paper is too dark on a dark page. */
const isDark = matchMedia("(prefers-color-scheme: dark)"), ON_DARK = { "#0072B2": "#8CA6FF" };
const colour = (event) => (isDark.matches && ON_DARK[DATA.looks[event][0]]) || DATA.looks[event][0];
const key = (event) =>
  `<span class="key" style="color: ${colour(event)}">${GLYPHS[DATA.looks[event][1]]}</span>`;

// All computations use a unit of length in which the box is of order one; printed values are
// multiplied by it. It is also the unit of time, because the speed is 1.
let unit;

/** The power of ten next to the shorter side of a box. */
const unitOf = ({ width, height }) => (
  Number(`1e${Math.round(Math.log10(Math.min(width, height)))}`));

/** A length or a time in units, without the last bits that the division adds. */
const inUnits = (value) => Number((value / unit).toPrecision(15));

/** The printed value of a number of the scene. Field and friction are per length. */
const printed = (name) => (RATES.includes(name) ? state[name] / unit : unit * state[name]);

const state = { paused: matchMedia("(prefers-reduced-motion: reduce)").matches };

const effects = () => ({ periodic: state.periodic, field: state.field, friction: state.friction });

/** Whether an event exists in the scene, though it may be impossible at this radius. */
const exists = (event) => !NEEDED[event]
  || [...NEEDED[event]].some((axis) => !state.periodic.includes(axis));

let asked; // {name: number} of the address
let runs; // the statistics of the scene
let curves; // the exact mean times of its box
let drawn; // the run in the drawing: {pair, time, trail, flash}

// Controls -----------------------------------------------------------------------------------

/** The largest radius of the slider, slightly below the largest radius of the box. */
const lastRadius = () => Math.floor(999 * largestRadius(state.width, state.height, effects())) / 1000;

/** Take a box and its unit; the sliders reach all boxes of the build with the same unit. */
function choose(box) {
  unit = unitOf(box);
  const boxes = [box, ...DATA.scenes.filter((scene) => unitOf(scene) === unit)];
  for (const [side, low, high] of [["width", 0.5, 3], ["height", 0.5, 2]]) {
    const sides = boxes.map((scene) => inUnits(scene[side]));
    at(side).min = Math.min(low, ...sides);
    at(side).max = Math.max(high, ...sides);
    state[side] = sides[0];
  }
}

/** Take the effects of a scene, in any unit. */
function chooseEffects({ periodic = "", field = 0, friction = 0 }) {
  Object.assign(state, { periodic, field: field * unit, friction: friction * unit });
}

/** Read the address; name its parts that this page cannot show. */
function readAddress() {
  const given = [...new URLSearchParams(location.hash.slice(1))];
  const periodic = Object.fromEntries(given).periodic ?? "";
  const taken = ([name, text]) => (name === "periodic" ? ["x", "y", "xy"].includes(text)
    : KEYS.includes(name) && text !== "" && Number(text) < Infinity
      && (LENGTHS.includes(name) ? Number(text) > 0 : Number(text) >= 0)
      && !(name === "field" && Number(text) && periodic.includes("y")));
  const wrong = given.filter((pair) => !taken(pair)).map((pair) => pair.join("="));
  const problem = wrong.length
    ? `The address asks for ${wrong.join(", ")}: this page knows ${KEYS.join(", ")}, each a number, and `
      + "periodic, which is x, y or xy. A field needs walls along y." : "";
  asked = Object.fromEntries(given.filter(taken).map(
    ([name, text]) => [name, name === "periodic" ? text : Number(text)]));
  const first = DATA.scenes[0] ?? { width: 1.5, height: 1 };
  choose({ width: asked.width ?? first.width, height: asked.height ?? first.height });
  // In every box, discs of this radius can hop in both ways.
  const usual = Number((Math.min(state.width, state.height) / 5).toFixed(3));
  state.radius = "radius" in asked ? inUnits(asked.radius) : usual;
  const own = [...SIDES, "periodic", ...RATES].some((name) => name in asked);
  chooseEffects(own ? asked : first);
  changed();
  at("problem").append(problem);
}

/** Write the scene into the address, so that a copy of the address shows the same scene. */
function writeAddress() {
  for (const name of NUMBERS) asked[name] = short(printed(name), 12);
  asked.periodic = state.periodic;
  for (const name of ["periodic", ...RATES]) if (!state[name]) delete asked[name];
  history.replaceState(null, "", `#${new URLSearchParams(asked)}`);
}

/** Take a typed number, with a point or a comma; a box of another size gets new sliders. */
function typed(name, text) {
  const value = Number(text.trim().replace(",", ".") || NaN);
  if (value < Infinity && (value > 0 || (value === 0 && RATES.includes(name)))) {
    const numbers = Object.fromEntries(NUMBERS.map((each) => [each, printed(each)]));
    numbers[name] = value;
    if (SIDES.includes(name)) choose(numbers);
    state.radius = inUnits(numbers.radius);
    chooseEffects({ ...numbers, periodic: state.periodic });
    changed();
  } else {
    showControls();
    at("problem").textContent = `${name} must be a number ${RATES.includes(name) ? "from 0 on" : "above 0"}, `
      + `such as 0.5, not "${text}".`;
  }
}

function prepareControls() {
  at("radius").min = 0.01;
  for (const name of LENGTHS) {
    const slider = at(name);
    slider.addEventListener("input", () => {
      state[name] = Number(slider.value);
      changed();
    });
    slider.addEventListener("change", writeAddress);
  }
  for (const name of NUMBERS) {
    numberOf(name).addEventListener("change", (event) => {
      typed(name, event.target.value);
      writeAddress();
    });
  }
  for (const axis of "xy") {
    at(axis).addEventListener("change", () => {
      state.periodic = [..."xy"].filter((each) => at(each).checked).join("");
      changed();
      writeAddress();
    });
  }
  for (const scene of DATA.scenes) {
    const button = document.createElement("button");
    button.type = "button";
    const more = ["periodic", ...RATES].filter((name) => scene[name]);
    button.textContent = [`${short(scene.width, 12)} × ${short(scene.height, 12)}`,
      ...more.map((name) => `${name} ${scene[name]}`)].join(", ");
    button.title = `The box of the scene ${scene.name}, with the points of its tables`;
    button.addEventListener("click", () => {
      choose(scene);
      chooseEffects(scene);
      changed();
      writeAddress();
    });
    at("buttons").append(button);
  }
  at("pause").addEventListener("click", () => {
    state.paused = !state.paused;
    showPause();
  });
  at("hop").addEventListener("change", renew);
  addEventListener("hashchange", readAddress);
}

function showPause() {
  at("pause").textContent = state.paused ? "Run" : "Pause";
}

/** The number field of a number, which is next to its slider if it has one. */
const numberOf = (name) => (RATES.includes(name) ? at(name) : at(name).nextElementSibling);

function showControls() {
  at("radius").max = lastRadius();
  for (const name of NUMBERS) {
    const text = short(printed(name), 12);
    numberOf(name).value = text;
    if (RATES.includes(name)) continue;
    Object.assign(at(name), { value: state[name], ariaValueText: text });
  }
  for (const axis of "xy") at(axis).checked = state.periodic.includes(axis);
  at("field").disabled = state.periodic.includes("y");
}

/** Start again with another box or radius, and name the numbers that are out of range. */
function changed() {
  if (state.periodic.includes("y")) state.field = 0; // else the discs would fall for ever
  const wanted = Object.fromEntries(NUMBERS.map((name) => [name, printed(name)]));
  for (const name of RATES) state[name] = Math.min(state[name], STRONGEST[name]);
  state.radius = Math.min(Math.max(state.radius, 0.01), lastRadius());
  at("problem").textContent = NUMBERS.filter((name) => printed(name) !== wanted[name]).map(
    (name) => `${name} ${short(wanted[name], 12)} is out of range: this page shows ${short(printed(name), 12)}.`,
  ).join(" ");
  showControls();
  at("duration").textContent = short(unit * DURATION);
  runs = new Runs(state.width, state.height, state.radius, asked.seed ?? DATA.seed, effects());
  show(runs.current);
  const possible = [0, 1].filter((hop) => runs.exact.times[COUNTED[hop]] !== null);
  if (possible.length === 1) at("hop").value = possible[0];
  curves = exactCurves();
  at("points").textContent = Object.values(builtScene()?.points ?? {}).some(
    ({ dynamics, monte_carlo }) => dynamics.length + monte_carlo.length)
    ? "small symbols are points of this build, filled by molecular dynamics, open by Monte Carlo."
    : "the build has no points of this box.";
  renew();
  draw();
}

// The drawing --------------------------------------------------------------------------------

function show(initial) {
  const pair = new Pair(...runs.scene, initial);
  drawn = { pair, time: 0, trail: [[0, pair.x1, pair.y1, pair.x2, pair.y2]], flash: null };
}

/** Move the drawn pair by `time`; after the end of its run another run follows. */
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
  if (drawn.time >= DURATION) show(runs.finished ?? runs.current);
}

function draw() {
  const canvas = at("box"), context = canvas.getContext("2d");
  const density = devicePixelRatio || 1;
  const [wide, high] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = wide * density;
  canvas.height = high * density;
  // The name of a hop is written above the box, not on the discs.
  const above = 22, middle = (high + above) / 2;
  const scale = Math.min((wide - 8) / state.width, (high - above - 8) / state.height);
  context.setTransform(
    scale * density, 0, 0, -scale * density, canvas.width / 2, middle * density);
  const line = 1 / scale;
  const { pair, trail, flash, time } = drawn;
  const discs = [
    [pair.x1, pair.y1, colour(DISCS[0])],
    [pair.x2, pair.y2, colour(DISCS[1])],
  ];

  const { width, height, periodic } = state;
  context.fillStyle = ink("--inside");
  context.fillRect(-width / 2, -height / 2, width, height);
  // Walls, and dashed lines where the box repeats itself.
  for (const [axis, right, up] of [["x", 0, height], ["y", width, 0]]) {
    const ring = periodic.includes(axis);
    context.lineWidth = (ring ? 1 : 3) * line;
    context.setLineDash(ring ? [5 * line, 5 * line] : []);
    context.strokeStyle = ink(ring ? "--soft" : "--ink");
    for (const side of [-0.5, 0.5]) {
      context.beginPath();
      context.moveTo(side * (width - right) - right / 2, side * (height - up) - up / 2);
      context.lineTo(side * (width - right) + right / 2, side * (height - up) + up / 2);
      context.stroke();
    }
  }
  context.setLineDash([]);

  context.lineWidth = 1.5 * line;
  context.save();
  if (periodic) {
    context.beginPath();
    context.rect(-width / 2, -height / 2, width, height);
    context.clip();
  }
  // The images of the discs that may be in the box.
  const images = (axis, side) => (periodic.includes(axis) ? [-side, 0, side] : [0]);
  for (const right of images("x", width)) for (const up of images("y", height)) {
    context.save();
    context.translate(right, up);
    for (const [disc, [, , paint]] of discs.entries()) {
      context.strokeStyle = paint;
      for (let i = 1; i < trail.length; i++) {
        const [from, to] = [trail[i - 1], trail[i]].map(
          (point) => point.slice(1 + 2 * disc, 3 + 2 * disc));
        // No line through the box for a disc that comes back on the other side.
        if (Math.abs(to[0] - from[0]) > width / 2 || Math.abs(to[1] - from[1]) > height / 2) continue;
        context.globalAlpha = 0.8 * Math.max(0, 1 - (time - trail[i][0]) / 1.5);
        context.beginPath();
        context.moveTo(...from);
        context.lineTo(...to);
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
    context.restore();
  }
  context.restore();

  const age = flash ? time - flash.since : Infinity;
  if (age >= 0.35) return;
  // The line through both centres at the hop, drawn at their present positions.
  const isHorizontal = flash.name === "horizontal hop";
  const x = (pair.x1 + pair.x2) / 2, y = (pair.y1 + pair.y2) / 2;
  context.globalAlpha = 1 - age / 0.35;
  context.setLineDash([6 * line, 4 * line]);
  context.strokeStyle = ink("--ink");
  context.beginPath();
  context.moveTo(isHorizontal ? x : -state.width / 2, isHorizontal ? -state.height / 2 : y);
  context.lineTo(isHorizontal ? x : state.width / 2, isHorizontal ? state.height / 2 : y);
  context.stroke();
  context.setTransform(density, 0, 0, density, 0, 0);
  context.textAlign = "center";
  context.fillStyle = ink("--ink");
  context.font = "600 14px system-ui, sans-serif";
  context.fillText(flash.name, wide / 2, middle - (scale * state.height) / 2 - 7);
}

// The table ----------------------------------------------------------------------------------

const spaced = (number) => number.toLocaleString("en").replaceAll(",", "\u202f");

const isUsual = (number) => number === 0 || (number >= 1e-3 && number < 1e5);

const exponential = (number, digits) => number.toExponential(digits).replace("+", "");

/** A number to some digits, with an exponent only if it is very small or large. */
function short(number, digits = 4) {
  const rounded = Number(number.toPrecision(digits));
  return isUsual(rounded) ? String(rounded) : exponential(rounded);
}

/** Return a function that writes numbers with the decimals of two digits of an error. */
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
      spaced(count),
      time === null ? "–" : rounded(time),
      error === null ? "–" : `${((100 * error) / time).toPrecision(2)} %`,
      exact === null ? (exists(event) ? "never" : "–") : rounded(exact),
      z === null ? "–" : `${z < 0 ? "−" : "+"}${Math.abs(z).toFixed(1)}`.replace("−0.0", "+0.0"),
    ];
    const row = cells.map((cell) => `<td>${cell}</td>`).join("");
    return `<tr id="${event}"><th scope="row">${key(event)} ${NAMES[event]}</th>${row}</tr>`;
  }).join("");
  const { done, events } = runs;
  const number = events < 1e6 ? spaced(events) : `${(events / 1e6).toFixed(1)} million`;
  at("status").textContent = done
    ? `${spaced(done)} runs of ${short(unit * DURATION)} time units, ${number} events`
    : state.paused ? "Paused: press Run to count." : "";
}

// The plots ----------------------------------------------------------------------------------

/** {radii, times: {event: mean times}}: dense near the ends of each regime, where curves bend. */
function exactCurves() {
  const { width, height } = state;
  const ends = thresholds(width, height, effects()).map(([radius]) => radius);
  const edges = [0, ...ends, largestRadius(width, height, effects())];
  const radii = edges.slice(1).flatMap((high, i) => Array.from({ length: DENSE }, (_, j) =>
    edges[i] + (high - edges[i]) * Math.sin((Math.PI / 2) * ((j + 0.5) / DENSE)) ** 2));
  const computed = radii.map((radius) => [radius, exact(width, height, radius, effects())]);
  const kept = computed.filter(([, numbers]) => numbers !== null);
  return {
    radii: kept.map(([radius]) => radius),
    times: Object.fromEntries(
      COUNTED.map((event) => [event, kept.map(([, { times }]) => times[event])])),
  };
}

/** The tables of the build for the scene, if it is one of its scenes; friction changes no time. */
const builtScene = () => DATA.scenes.find(({ width, height, periodic = "", field = 0 }) =>
  inUnits(width) === state.width && inUnits(height) === state.height
  && periodic === state.periodic && field * unit === state.field);

/** Draw the curves, and points with errors, from the build and from the counts of this page. */
function paintTimes(plot) {
  for (const [radius] of thresholds(state.width, state.height, effects())) {
    plot.line(radius, ink("--grid"), [4, 4]);
  }
  for (const event of COUNTED) plot.curve(curves.radii, curves.times[event], colour(event));
  const symbol = (event, [radius, time, error], size, fill, line = 1) => plot.point(
    radius, time, error, { marker: DATA.looks[event][1], size, colour: colour(event), fill, line });
  const built = builtScene(), open = `${ink("--page")}99`;
  for (const event of COUNTED) {
    const { monte_carlo, dynamics } = built?.points[event] ?? { monte_carlo: [], dynamics: [] };
    for (const row of monte_carlo) symbol(event, row.map(inUnits), 4.2, open);
    for (const row of dynamics) symbol(event, row.map(inUnits), 1.9, colour(event));
  }
  COUNTED.forEach((event, i) => {
    const { time, error } = runs.measured(i);
    if (time !== null) symbol(event, [state.radius, time, error], 7, open, 2.5);
  });
}

const timesPlot = new Plot(at("times"), {
  x: {
    label: "radius r (length)",
    range: () => [0, 1.03 * largestRadius(state.width, state.height, effects())],
    text: (tick) => short(unit * tick),
    marks: () => thresholds(state.width, state.height, effects()),
  },
  y: {
    label: "mean time τ (length/speed)",
    log: true,
    range: () => SHOWN_TIMES,
    text: (tick) => short(unit * tick),
  },
  paint: paintTimes,
  read: (radius) => {
    const numbers = radius > 0 && exact(state.width, state.height, radius, effects());
    if (!numbers) return `r = ${short(unit * radius)}: the discs do not fit`;
    const times = COUNTED.filter(exists).map((event) => {
      const time = numbers.times[event];
      return `${NAMES[event]} ${time === null ? "never" : short(unit * time)}`;
    });
    return `r = ${short(unit * radius)}: ${times.join(", ")}`;
  },
});

/** The hop of the histogram: its event, and its bins as densities, null for an empty bin. */
function intervals() {
  const hop = Number(at("hop").value), { bins, mean, total } = runs.histograms[hop];
  const width = REACH / BINS;
  const density = Array.from(bins, (count) => (count ? count / (total * width) : null));
  return { event: COUNTED[hop], density, mean, total, width };
}

const intervalsPlot = new Plot(at("intervals"), {
  x: { label: "interval t/τ, τ the exact mean time", range: () => [0, REACH], text: short },
  y: {
    label: "probability density × τ",
    log: true,
    range: () => [1e-3, Math.max(3, 1.5 * Math.max(...intervals().density))],
    text: short,
  },
  paint: (plot) => {
    const { event, density, mean, width } = intervals();
    plot.bars(density.map((_, i) => (i + 0.5) * width), density, width, colour(event));
    if (mean !== null) plot.curve([0, REACH], [1, Math.exp(-REACH)], ink("--ink"), [7, 4]);
  },
  read: (x) => {
    const { density, mean, width } = intervals(), bin = Math.min(Math.floor(x / width), BINS - 1);
    const counted = density[bin] === null ? "none" : short(density[bin], 3);
    return mean === null ? "" : `t/τ = ${short(x, 3)}: counted ${counted}, exponential ${short(Math.exp(-x), 3)}`;
  },
});

function showIntervals() {
  const { event, mean, total } = intervals();
  intervalsPlot.draw();
  at("explanation").textContent = mean === null
    ? (exists(event) ? "In this box discs of this radius" : "Along a periodic axis discs")
      + ` make no ${NAMES[event]}.`
    : `Bars are ${spaced(total)} intervals; the dashed line is the exponential of the exact mean,`
      + ` τ = ${short(unit * mean)}: the law of independent hops.`;
}

/** Renew all numbers. */
function renew() {
  showTable();
  showIntervals();
  timesPlot.draw();
}

function prepareTexts() {
  at("enough").textContent = ENOUGH;
  at("boxes").textContent = DATA.scenes.length ? "Boxes of the build:" : "";
  const named = COUNTED.map((event) => `<span class="name">${key(event)} ${NAMES[event]}</span>`);
  at("legend").innerHTML = named.join(" ");
  at("discs").innerHTML = DISCS.map((event, i) => (
    `<span class="name"><span class="key" style="color: ${colour(event)}">●</span> disc ${i + 1}</span>`
  )).join(" ");
}

// Time ---------------------------------------------------------------------------------------

let before = null, renewed = 0;

function frame(now) {
  if (!state.paused) {
    // After the browser has paused a hidden page, the missing time is skipped.
    move((SPEED * Math.min(now - (before ?? now), 50)) / 1000);
    const begun = performance.now();
    for (let i = 0; i < CHUNKS && performance.now() - begun < SHARE; i++) runs.advance(CHUNK, asked.runs);
    draw();
    if (now - renewed > RENEWED) {
      renew();
      renewed = now;
    }
  }
  before = now;
  requestAnimationFrame(frame);
}

prepareControls();
prepareTexts();
readAddress();
showPause();
for (const [target, event] of [[window, "resize"], [isDark, "change"]]) {
  target.addEventListener(event, () => {
    prepareTexts();
    renew();
    draw();
  });
}
// A page that has this one in a frame makes the frame as high.
const whole = document.querySelector("main");
new ResizeObserver(() => parent.postMessage({ explorer: whole.offsetHeight }, "*")).observe(whole);
requestAnimationFrame(frame);
