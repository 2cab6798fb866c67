// Lines over an axis, drawn by uPlot from arrays of any length: what lies within a pixel is drawn from its least to its largest value,
// and the values under the pointer are those of the arrays.

/* global uPlot */

const HEIGHT = 190;
/** Of lines, in pixels: a browser without a graphics card strokes wider ones many times slower. */
const WIDTH = 1;
/** Letters of a title that are shown; the rest appears only while the pointer is on it. */
const LONGEST_TITLE = 60;

const colours = new Map();

/** A colour of the theme, asked of the style sheet once: asking lays the page out. */
export function colour(name) {
  if (!colours.get(name)) colours.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
  return colours.get(name);
}

/** Another theme is shown. */
export function forgetColours() {
  colours.clear();
}

/** A number as one reads it. */
export function shown(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 1e6 || size < 1e-3 ? value.toExponential(digits - 2) : String(Number(value.toPrecision(digits)));
}

/** A line: y over from, from + step, … */
export function line(label, y, from, step, look = "now", dash = null) {
  return { label, y, from, step, look, dash };
}

const lastX = ({ y, from, step }) => from + step * Math.max(y.length - 1, 0);

/** Writes the values of a line at both sides of each column. @returns whether others stood there */
function columnsOf({ y, from, step }, [least, most], columns, into) {
  const width = (most - least) / columns;
  let isOther = false;
  for (let column = 0; column < columns; column++) {
    const start = (least + column * width - from) / step;
    const end = start + width / step;
    let first = Math.max(Math.ceil(start), 0);
    const last = Math.min(Math.ceil(end) - 1, y.length - 1);
    let [a, b] = [NaN, NaN];
    if (first <= last) {
      [a, b] = [y[first], y[first]];
      let rises = true;
      for (let index = first + 1; index <= last; index++) {
        const value = y[index];
        if (value < a) { a = value; rises = false; } else if (value > b) { b = value; rises = true; }
      }
      if (!rises) [a, b] = [b, a];
    } else if (start >= 0 && end <= y.length - 1) {
      const before = Math.floor(start);
      const at = (place) => y[before] + (y[Math.min(before + 1, y.length - 1)] - y[before]) * (place - before);
      [a, b] = [at(start), at(end)];
    }
    isOther = put(into, 2 * column, a) || isOther;
    isOther = put(into, 2 * column + 1, b) || isOther;
  }
  return isOther;
}

/** Writes a number, or a gap for what is none. @returns whether another stood there */
function put(into, index, number) {
  const value = Number.isFinite(number) ? number : null;
  if (into[index] === value) return false;
  into[index] = value;
  return true;
}

export class Plot {
  #element;
  #options;
  #lines = [];
  #bands = [];
  #marks = [];
  #labels = [];
  #triangles = [];
  #isLog = false;
  #mark = null;
  #range = [0, 1];
  #zoomed = null;
  #plot = null;
  #marker = null;
  #builtAs = "";
  #framedAs = "";
  #named = "";
  #shownAt = null;
  #values;
  #title;
  #empty;
  #buffers = [];
  #describing = 0;
  #isSeen = true;
  #isWaiting = false;

  /** @param options title, x and y with their units, kind: "line" or "points" */
  constructor(element, options) {
    this.#element = element;
    this.#options = options;
    element.tabIndex = 0;
    element.setAttribute("role", "group");
    const head = document.createElement("div");
    head.className = "title";
    this.#title = document.createElement("span");
    this.#values = document.createElement("span");
    this.#values.className = "values";
    head.append(this.#title, this.#values);
    this.#empty = document.createElement("p");
    this.#empty.className = "empty";
    this.#empty.hidden = true;
    element.append(head, this.#empty);
    element.addEventListener("keydown", (event) => this.#key(event));
    element.addEventListener("dblclick", () => this.zoom(null));
    new ResizeObserver(() => this.#resize()).observe(element);
    new IntersectionObserver((entries) => this.#see(entries.at(-1).isIntersecting)).observe(element);
    this.#head(options.title);
    this.set([]);
  }

  #head(title) {
    this.#title.title = title;
    this.#title.textContent = title.length > LONGEST_TITLE ? `${title.slice(0, LONGEST_TITLE).replace(/[\s,;]*\S*$/, "")} …` : title;
  }

  /**
   * Draws lines; what was zoomed stays so.
   * @param range shown where nothing is zoomed
   * @param marks places on the axis that a line is drawn at, such as mesh orders
   * @param labels places and names: a line is drawn at each, with its name along it
   * @param triangles places that small triangles at the top point to, such as natural frequencies
   * @param isLog whether y is logarithmic
   */
  set(lines, { range = null, bands = [], marks = [], labels = [], triangles = [], isLog = false, title = null, x = null, y = null, empty = "" } = {}) {
    this.#lines = lines.filter(({ y: values }) => values?.length);
    this.#bands = bands;
    this.#marks = [...marks, ...labels.map(([place]) => place)];
    this.#labels = labels;
    this.#triangles = triangles;
    this.#isLog = isLog;
    if (title) this.#head(title);
    if (x) this.#options.x = x;
    if (y) this.#options.y = y;
    const least = Math.min(...this.#lines.map(({ from }) => from));
    const most = Math.max(...this.#lines.map(lastX));
    this.#range = range ?? (this.#lines.length && most > least ? [least, most] : [0, 1]);
    this.#empty.textContent = empty;
    this.#empty.hidden = this.#lines.length > 0 || !empty;
    const named = this.#lines.map(({ label, look }) => [label, look]).join();
    if (named !== this.#named || this.#shownAt !== null) this.#say();
    this.#named = named;
    this.#draw();
  }

  /** Marks a place on the axis. */
  mark(x) {
    this.#mark = x;
    this.#placeMark();
  }

  get view() {
    return this.#zoomed ?? this.#range;
  }

  zoom(range) {
    if (range && !(range[1] - range[0] > 1e-9 * Math.max(1, Math.abs(range[0])))) return;
    this.#zoomed = range;
    this.#draw();
  }

  repaint() {
    this.#plot?.destroy();
    this.#plot = null;
    this.#say();
    this.#draw();
  }

  /** What is out of sight is drawn once it comes into sight. */
  #see(isSeen) {
    this.#isSeen = isSeen;
    this.#element.classList.toggle("unseen", !isSeen);
    if (isSeen && this.#isWaiting) this.#draw();
    this.#placeMark();
  }

  #draw() {
    // Not before the picture is seen.
    clearTimeout(this.#describing);
    this.#describing = setTimeout(() => this.#describe(), 200);
    this.#isWaiting = !this.#isSeen;
    if (this.#isWaiting) return;
    const builtAs = this.#lines.map(({ label, look, dash }) => [label, look, dash]).join() + this.#options.x + this.#options.y + this.#isLog;
    if (!this.#plot || builtAs !== this.#builtAs) this.#build();
    this.#builtAs = builtAs;
    const view = this.view;
    const isPoints = this.#options.kind === "points";
    // One column a pixel.
    const columns = this.#plot.width;
    const count = isPoints ? (this.#lines[0]?.y.length ?? 0) : 2 * columns;
    const buffer = (index) => {
      if (this.#buffers[index]?.length !== count) this.#buffers[index] = new Array(count);
      return this.#buffers[index];
    };
    const framedAs = [view, this.#bands, this.#marks, this.#labels, this.#triangles, columns, builtAs].join();
    let isOther = framedAs !== this.#framedAs;
    this.#framedAs = framedAs;
    const xs = buffer(0);
    const width = (view[1] - view[0]) / columns;
    for (let k = 0; k < count; k++) {
      const x = isPoints ? this.#lines[0].from + k * this.#lines[0].step : view[0] + ((k >> 1) + (k & 1 ? 0.75 : 0.25)) * width;
      isOther = put(xs, k, x) || isOther;
    }
    const ys = this.#lines.map((entry, index) => {
      const into = buffer(index + 1);
      if (!isPoints) isOther = columnsOf(entry, view, columns, into) || isOther;
      else for (let k = 0; k < count; k++) isOther = put(into, k, entry.y[k]) || isOther;
      return into;
    });
    // What looks alike stays.
    if (!isOther) return;
    this.#plot.batch(() => {
      this.#plot.setData([xs, ...ys], false);
      this.#plot.setScale("x", { min: view[0], max: view[1] });
    });
  }

  #build() {
    this.#plot?.destroy();
    const axis = (label, size) => ({
      label, size, labelSize: 18, gap: 3, labelGap: 0, font: "12px system-ui", labelFont: "12px system-ui",
      stroke: () => colour("muted"), grid: { stroke: () => colour("grid"), width: 1 }, ticks: { stroke: () => colour("line"), width: 1 },
      values: (_, splits) => splits.map((value) => (value === null ? "" : String(Number(value.toPrecision(6))))),
    });
    const isPoints = this.#options.kind === "points";
    const series = this.#lines.map(({ label, look, dash }) => ({
      label, stroke: () => colour(look), width: WIDTH, dash: dash ?? undefined, spanGaps: isPoints,
      points: { show: isPoints, size: 6, fill: () => colour(look) },
    }));
    this.#plot = new uPlot({
      width: Math.max(this.#element.clientWidth, 200),
      height: HEIGHT,
      legend: { show: false },
      cursor: { y: false, points: { show: false }, drag: { x: true, y: false, setScale: false } },
      scales: {
        x: { time: false, auto: false },
        y: this.#isLog ? { distr: 3, range: (_, least, most) => decades(least, most) } : { range: (_, least, most) => around(least, most) },
      },
      axes: [axis(this.#options.x, 34), axis(this.#options.y, 62)],
      series: [{}, ...series],
      hooks: {
        drawClear: [(plot) => this.#drawBands(plot)],
        draw: [() => this.#placeMark()],
        setSelect: [(plot) => this.#select(plot)],
        setCursor: [(plot) => this.#hover(plot)],
      },
    }, [[], ...series.map(() => [])], this.#element);
    this.#marker = document.createElement("div");
    this.#marker.className = "mark";
    this.#plot.over.append(this.#marker);
    this.#framedAs = "";
  }

  #select(plot) {
    const { left, width } = plot.select;
    if (width < 4) return;
    const range = [left, left + width].map((place) => plot.posToVal(place, "x"));
    plot.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
    this.zoom(range);
  }

  /** The lines' own values nearest to the pointer. */
  #hover(plot) {
    const { left } = plot.cursor;
    if (left === null || left === undefined || left < 0) {
      this.#legend();
      return;
    }
    this.showAt(plot.posToVal(left, "x"));
  }

  /** The values where they are shown, otherwise the names. */
  #say() {
    if (this.#shownAt === null) this.#legend();
    else this.showAt(this.#shownAt);
  }

  /** The names of lines that lie over each other, in their colours. */
  #legend() {
    this.#shownAt = null;
    const names = this.#lines.length > 1 ? this.#lines : [];
    this.#values.replaceChildren(...names.flatMap(({ label, look }) => {
      const name = Object.assign(document.createElement("b"), { textContent: label });
      name.style.color = colour(look);
      return [name, document.createTextNode(" ")];
    }));
  }

  showAt(x) {
    this.#shownAt = x;
    const at = ({ y, from, step }) => {
      const index = Math.round((x - from) / step);
      return index >= 0 && index < y.length ? y[index] : NaN;
    };
    const parts = [document.createTextNode(`${shown(x, 5)}: `)];
    for (const entry of this.#lines) {
      const value = document.createElement("b");
      value.textContent = shown(at(entry));
      value.style.color = colour(entry.look);
      if (this.#lines.length > 1) parts.push(document.createTextNode(` ${entry.label} `));
      parts.push(value);
    }
    this.#values.replaceChildren(...parts);
  }

  #drawBands(plot) {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.strokeStyle = colour("held");
    ctx.setLineDash([3, 4]);
    ctx.beginPath();
    for (const place of this.#marks) {
      const x = Math.round(plot.valToPos(place, "x", true)) + 0.5;
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
    }
    ctx.stroke();
    ctx.fillStyle = colour("muted");
    ctx.font = `${11 * devicePixelRatio}px system-ui`;
    [ctx.textAlign, ctx.textBaseline] = ["right", "top"];
    for (const [place, name] of this.#labels) {
      ctx.save();
      ctx.translate(plot.valToPos(place, "x", true) + 2 * devicePixelRatio, bbox.top + 3 * devicePixelRatio);
      ctx.rotate(-Math.PI / 2);
      ctx.fillText(name, 0, 0);
      ctx.restore();
    }
    const size = 5 * devicePixelRatio;
    ctx.fillStyle = colour("second");
    ctx.beginPath();
    for (const place of this.#triangles) {
      const x = plot.valToPos(place, "x", true);
      ctx.moveTo(x - size, bbox.top);
      ctx.lineTo(x + size, bbox.top);
      ctx.lineTo(x, bbox.top + 1.6 * size);
    }
    ctx.fill();
    ctx.fillStyle = colour("tint");
    for (const [from, to] of this.#bands) {
      const [left, right] = [from, to].map((x) => plot.valToPos(x, "x", true));
      ctx.fillRect(left, bbox.top, Math.max(right - left, 1), bbox.height);
    }
    ctx.restore();
  }

  /** An element of its own: the lines below it are not drawn anew while it moves. */
  #placeMark() {
    if (!this.#plot || !this.#isSeen) return;
    const isInView = this.#mark !== null && this.#mark >= this.view[0] && this.#mark <= this.view[1];
    this.#marker.hidden = !isInView;
    if (isInView) this.#marker.style.transform = `translateX(${this.#plot.valToPos(this.#mark, "x").toFixed(1)}px)`;
  }

  #key(event) {
    const [least, most] = this.view;
    const width = most - least;
    const middle = (least + most) / 2;
    const moves = {
      "+": [middle - width / 4, middle + width / 4],
      "-": [Math.max(middle - width, this.#range[0]), Math.min(middle + width, this.#range[1])],
      ArrowLeft: [least - width / 8, most - width / 8],
      ArrowRight: [least + width / 8, most + width / 8],
      0: null,
    };
    if (!(event.key in moves) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    this.zoom(moves[event.key]);
    if (this.#lines.length) this.showAt((this.view[0] + this.view[1]) / 2);
  }

  #resize() {
    const width = this.#element.clientWidth;
    if (!this.#plot || width === 0 || width === this.#plot.width) return;
    this.#plot.setSize({ width, height: HEIGHT });
    this.#draw();
  }

  /** For those who do not see it. */
  #describe() {
    const of = this.#lines.map(({ label, y }) => {
      let [least, most] = [Infinity, -Infinity];
      for (let k = 0; k < y.length; k++) {
        if (y[k] < least) least = y[k];
        if (y[k] > most) most = y[k];
      }
      return `${label} from ${shown(least)} to ${shown(most)}`;
    });
    const said = `${this.#title.title}: ${this.#options.y} over ${this.#options.x}. ${of.join("; ")}`;
    if (this.#element.getAttribute("aria-label") !== said) this.#element.setAttribute("aria-label", said);
  }
}

function around(least, most) {
  if (least === null || most === null || !Number.isFinite(least + most)) return [0, 1];
  const room = 0.06 * (most - least) || 0.1 * Math.abs(most) || 1;
  return [least === 0 ? 0 : least - room, most + room];
}

/** Decades of a logarithmic scale that are shown. */
const DECADES = 5;

function decades(least, most) {
  if (!(most > 0)) return [1e-3, 1];
  return [Math.max(least > 0 ? least : 0, most * 10 ** -DECADES), 1.5 * most];
}
