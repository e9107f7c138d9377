"use strict";
// Plots on a canvas: axes with ticks, curves, bars, points with errors, and a cursor to read them.

/** The value of a custom property of the page's style, such as "--ink": light or dark. */
const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

const MARKERS = {
  s: [[-0.85, -0.85], [0.85, -0.85], [0.85, 0.85], [-0.85, 0.85]],
  "^": [[0, -1.15], [1, 0.75], [-1, 0.75]],
  v: [[0, 1.15], [1, -0.75], [-1, -0.75]],
  D: [[0, -1.2], [1.2, 0], [0, 1.2], [-1.2, 0]],
  P: [
    [-0.4, -1.1], [0.4, -1.1], [0.4, -0.4], [1.1, -0.4], [1.1, 0.4], [0.4, 0.4],
    [0.4, 1.1], [-0.4, 1.1], [-0.4, 0.4], [-1.1, 0.4], [-1.1, -0.4], [-0.4, -0.4],
  ],
};

/** An axis {label, range, log, text, marks} and its ticks: `range()` is [low, high], `text` writes a
 *  tick, `marks()` are [value, name], written above the plot. */
class Axis {
  constructor(options) {
    Object.assign(this, options);
    this.scale = this.log ? Math.log10 : Number;
  }

  /** The position of a value as a fraction of the axis. */
  fraction(value) {
    const [low, high] = this.range().map(this.scale);
    return (this.scale(value) - low) / (high - low);
  }

  /** Round values between the ends of the axis, at most `many`. */
  ticks(many) {
    const [low, high] = this.range().map(this.scale);
    const coarse = (high - low) / many, power = 10 ** Math.floor(Math.log10(coarse));
    const steps = this.log ? [1, 2, 3, 4] : [1, 2, 5, 10].map((digit) => digit * power);
    const step = steps.find((size) => size >= coarse) ?? steps.at(-1);
    const first = Math.ceil(low / step - 1e-9), last = Math.floor(high / step + 1e-9);
    return Array.from({ length: last - first + 1 }, (_, i) => {
      const tick = Number(((first + i) * step).toPrecision(12));
      return this.log ? 10 ** tick : tick;
    });
  }
}

/** A plot in the canvas of `holder`, which `paint(plot)` fills. The text `read(x)` at the cursor is
 *  written below it. */
class Plot {
  constructor(holder, { x, y, paint, read }) {
    Object.assign(this, { x: new Axis(x), y: new Axis(y), paint, read, cursor: null });
    this.canvas = holder.querySelector("canvas");
    this.readout = holder.querySelector("output");
    this.canvas.addEventListener("pointermove", (event) => this.look(event.offsetX));
    this.canvas.addEventListener("pointerleave", () => this.look(NaN));
  }

  look(offset) {
    const fraction = (offset - this.left) / this.width;
    const [low, high] = this.x.range();
    this.cursor = fraction >= 0 && fraction <= 1 ? low + fraction * (high - low) : null;
    this.draw();
  }

  /** The pixels of a point. */
  at(x, y) {
    return [
      this.left + this.x.fraction(x) * this.width,
      this.top + (1 - this.y.fraction(y)) * this.height,
    ];
  }

  /** Draw everything again, in the width that the page gives. */
  draw() {
    const { canvas } = this, density = devicePixelRatio || 1, context = canvas.getContext("2d");
    const [wide, high] = [canvas.clientWidth, canvas.clientHeight];
    Object.assign(canvas, { width: wide * density, height: high * density });
    Object.assign(this, { context, left: 62, top: 22, width: wide - 74, height: high - 70 });
    context.scale(density, density);
    this.frame(wide, high);
    context.save();
    context.beginPath();
    context.rect(this.left, this.top, this.width, this.height);
    context.clip();
    this.paint(this);
    if (this.cursor !== null) this.line(this.cursor, ink("--soft"), []);
    context.restore();
    this.readout.value = this.cursor === null ? "" : this.read(this.cursor);
  }

  frame(wide, high) {
    const { context, left, top, width, height } = this, bottom = top + height;
    Object.assign(context, { strokeStyle: ink("--grid"), fillStyle: ink("--ink"), lineWidth: 1 });
    context.font = "13px system-ui, sans-serif";
    const [[xLow], [yLow]] = [this.x.range(), this.y.range()];
    for (const tick of this.x.ticks(width / 70)) {
      const [x] = this.at(tick, yLow);
      this.stroke([[x, top], [x, bottom]]);
      this.write(this.x.text(tick), x, bottom + 6, "center", "top");
    }
    for (const tick of this.y.ticks(height / 28)) {
      const [, y] = this.at(xLow, tick);
      this.stroke([[left, y], [left + width, y]]);
      this.write(this.y.text(tick), left - 6, y, "right", "middle");
    }
    (this.x.marks?.() ?? []).forEach(([value, name], i, { length }) => {
      // Two marks may be close: their names are on different sides. None is on the ticks of y.
      const [x] = this.at(value, yLow), align = length === 1 ? "center" : ["right", "left"][i];
      this.write(name, x, top - 5, x < left + 60 ? "left" : align, "bottom");
    });
    context.strokeStyle = ink("--soft");
    context.strokeRect(left, top, width, height);
    this.write(this.x.label, left + width / 2, high - 4, "center", "bottom");
    context.save();
    context.translate(2, top + height / 2);
    context.rotate(-Math.PI / 2);
    this.write(this.y.label, 0, 0, "center", "top");
    context.restore();
  }

  write(text, x, y, align, baseline) {
    Object.assign(this.context, { textAlign: align, textBaseline: baseline });
    this.context.fillText(text, x, y);
  }

  /** Stroke a path of pixels; null breaks it. */
  stroke(path) {
    this.context.beginPath();
    let pen = "moveTo";
    for (const pixels of path) {
      if (pixels) this.context[pen](...pixels);
      pen = pixels ? "lineTo" : "moveTo";
    }
    this.context.stroke();
  }

  curve(xs, ys, colour, dashes = []) {
    Object.assign(this.context, { strokeStyle: colour, lineWidth: 2 });
    this.context.setLineDash(dashes);
    this.stroke(xs.map((x, i) => (ys[i] === null ? null : this.at(x, ys[i]))));
    this.context.setLineDash([]);
  }

  /** A line from the bottom to the top. */
  line(x, colour, dashes) {
    this.curve([x, x], this.y.range(), colour, dashes);
  }

  bars(xs, ys, wide, colour) {
    Object.assign(this.context, { strokeStyle: colour, fillStyle: `${colour}40`, lineWidth: 1 });
    const [low] = this.y.range();
    xs.forEach((x, i) => {
      if (ys[i] === null) return;
      const [left, top] = this.at(x - wide / 2, ys[i]), [right, bottom] = this.at(x + wide / 2, low);
      this.context.fillRect(left, top, right - left, bottom - top);
      this.context.strokeRect(left, top, right - left, bottom - top);
    });
  }

  /** A symbol of some size at (x, y), filled with `fill`, with its error unless that is null. */
  point(x, y, error, { marker, size, colour, fill, line = 1 }) {
    const { context } = this, [u, v] = this.at(x, y);
    Object.assign(context, { strokeStyle: colour, fillStyle: fill, lineWidth: line });
    context.beginPath();
    if (marker === "o") context.arc(u, v, size, 0, 2 * Math.PI);
    else for (const [a, b] of MARKERS[marker]) context.lineTo(u + a * size, v + b * size);
    context.closePath();
    context.fill();
    context.stroke();
    if (error && error < y) this.stroke([this.at(x, y - error), this.at(x, y + error)]);
  }
}
