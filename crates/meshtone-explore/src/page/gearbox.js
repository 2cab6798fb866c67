// The page of a gearbox: the train, and what a signal shows of a wheel, a mesh and a bearing.

import { element } from "./controls.js";
import { GearboxControls } from "./gearbox_controls.js";
import { fold } from "./indicators.js";
import { Page, begin } from "./page.js";
import { Plot, forgetColours, line, shown } from "./plots.js";
import { Train } from "./train.js";

const byId = (id) => document.getElementById(id);
/** Revolutions of the input that are seen of a signal at first. */
const SEEN_REVOLUTIONS = 3;

class GearboxView {
  #plots;
  #train;
  #now = null;
  #full = null;
  #held = null;
  #recording = null;
  #look;
  #process;
  /** The bearing that the recording was asked for last. */
  #askedAgain = null;
  asked = { channel: null, wheel: null, mesh: null, bearing: null };

  /**
   * @param look is told that another channel, wheel, mesh or bearing is looked at
   * @param process is told that the recording is to be looked at again, for another bearing
   */
  constructor(look, process) {
    [this.#look, this.#process] = [look, process];
    const plot = (id, options) => new Plot(byId(id), options);
    this.#plots = {
      waveform: plot("waveform", { title: "Signal", x: "time (s)", y: "signal (g)" }),
      spectrum: plot("spectrum", { title: "Spectrum (dashed: harmonics of the selected mesh)", x: "frequency (Hz)", y: "amplitude (g)" }),
      average: plot("average", { title: "Average of the signal", x: "angle (°)", y: "signal (g)" }),
      envelope: plot("envelope", { title: "Squared envelope", x: "order of the shaft", y: "amplitude (g²)" }),
      force: plot("force", { title: "Force", x: "time (s)", y: "force (N)" }),
    };
    const choose = (key) => (name) => this.#chosen(key, name);
    this.#train = new Train(byId("front"), byId("above"), choose("wheel"), choose("mesh"), choose("bearing"));
    for (const key of Object.keys(this.asked)) byId(key).addEventListener("change", ({ target }) => this.#chosen(key, target.value));
    byId("turn").addEventListener("click", ({ target }) => target.setAttribute("aria-pressed", this.#train.turn()));
    byId("logarithmic").addEventListener("change", () => this.#now && this.#spectrum(this.#now));
    byId("all-indicators").addEventListener("change", () => this.#full && this.#indicators(this.#full));
  }

  /** The answer that can be held. */
  get held() {
    return this.#full;
  }

  rest() {}

  /** Another scenario is begun with. */
  forget() {
    Object.keys(this.asked).forEach((key) => { this.asked[key] = null; });
  }

  hold(answer) {
    this.#held = answer;
    if (this.#full) this.show(this.#full);
  }

  setRecording(processed) {
    this.#recording = processed;
    if (this.#full) this.show(this.#full);
  }

  repaint() {
    forgetColours();
    Object.values(this.#plots).forEach((drawn) => drawn.repaint());
  }

  #chosen(key, name) {
    this.asked[key] = name;
    this.#look();
  }

  show(answer) {
    this.#now = answer;
    const { signal, wheel, mesh, train: parts } = answer;
    Object.assign(this.asked, { channel: signal.name, wheel: wheel.name, mesh: mesh.name, bearing: answer.bearing?.name ?? this.asked.bearing });
    select("channel", answer.channels, signal.name);
    select("wheel", parts.wheels.map(({ name }) => name), wheel.name);
    select("mesh", parts.meshes.map(({ name }) => name), mesh.name);
    byId("figures").replaceChildren(...answer.figures.map(([name, value, unit]) => element("div", {}, element("dt", {}, name), element("dd", {}, `${shown(value)} ${unit}`))));
    byId("warnings").replaceChildren(...answer.warnings.map(({ key, message }) => element("li", {}, `${key}: ${message}`)));
    const isFull = answer.detail === "full";
    // While a control moves, too little is simulated for it.
    if (isFull) {
      this.#bearing(answer);
      this.#full = answer;
    }
    this.#train.show(parts, { wheel: wheel.name, mesh: mesh.name, bearing: byId("bearing").value });
    const step = 1 / signal.sampling_rate_hz;
    const seen = [signal.start_s, signal.start_s + Math.min(SEEN_REVOLUTIONS / parts.shafts[0].speed_hz, signal.values.length * step)];
    this.#plots.waveform.set(this.#beside(signal, line(signal.name, signal.values, signal.start_s, step),
      ({ signal: { values, start_s: start, sampling_rate_hz: rate } }, isRecorded) => [values, isRecorded ? signal.start_s : start, 1 / rate]), { y: `signal (${signal.unit})`, range: seen });
    this.#spectrum(answer);
    this.#revolution(answer);
    byId("mesh-title").textContent = `Force of mesh ${mesh.name}`;
    const force = this.#held ? [line("held", this.#held.mesh.force, this.#held.signal.start_s, 1 / this.#held.signal.sampling_rate_hz, "held")] : [];
    this.#plots.force.set([...force, line(mesh.name, mesh.force, signal.start_s, step, "second")], { range: seen });
    if (isFull) this.#indicators(answer);
  }

  /**
   * A line with those of what is held before it and of the recording behind it, where they have the signal's unit.
   * @param of gives values, first place and step of an answer; null where it has none
   */
  #beside(signal, now, of) {
    const other = (label, answer, look, unit) => {
      const found = answer && (unit === signal.unit || unit === "") ? of(answer, look === "recorded") : null;
      return found ? [line(label, ...found, look)] : [];
    };
    const { unit } = this.#recording?.signal.channel ?? {};
    return [...other("held", this.#held, "held", this.#held?.signal.unit), now, ...other("recording", this.#recording, "recorded", unit)];
  }

  #spectrum({ signal, spectrum, lines, train: { meshes }, mesh }) {
    const { frequency_hz: hz } = meshes.find(({ name }) => name === mesh.name);
    const most = spectrum.step_hz * (spectrum.values.length - 1);
    const marks = Array.from({ length: Math.floor(most / hz) }, (_, index) => (index + 1) * hz);
    const drawn = this.#beside(signal, line(signal.name, spectrum.values, 0, spectrum.step_hz), ({ spectrum: other }) => other && [other.values, 0, other.step_hz]);
    this.#plots.spectrum.set(drawn, { y: `amplitude (${signal.unit})`, marks, isLog: byId("logarithmic").checked });
    const zoom = (index) => this.#plots.spectrum.zoom([Math.max(lines[index][0] - 0.3 * hz, 0), lines[index][0] + 0.3 * hz]);
    table("lines", ["line", "frequency, Hz", `amplitude, ${signal.unit}`], lines.map(([frequency, amplitude, name]) => [name, shown(frequency, 5), shown(amplitude, 3)]), zoom);
    byId("lines-note").textContent = lines.length ? `The strongest ${lines.length} lines, each within ${shown(spectrum.step_hz, 3)} Hz of what it is named after. Choose one to see it.`
      : "Lines have names where speed and load are steady.";
  }

  /** The average over the revolutions of the wheel that is looked at. */
  #revolution({ signal, wheel }) {
    byId("wheel-title").textContent = `Over a revolution of ${wheel.name}, ${wheel.teeth} teeth`;
    const { average } = wheel;
    const over = (values) => values && [values, 0, 360 / values.length];
    const recorded = this.#recordedWheel(wheel);
    const drawn = average ? this.#beside(signal, line(signal.name, ...over(average.values)),
      (answer, isRecorded) => over(isRecorded ? recorded?.average : answer.wheel.average?.values)) : [];
    this.#plots.average.set(drawn, { y: `signal (${signal.unit})`, title: average ? `Average over ${average.revolutions} revolutions` : "Average", empty: wheel.problem ?? "needs a steady speed and a whole revolution" });
    byId("wheel-note").textContent = [wheel.problem, recorded?.problem && `Recording: ${recorded.problem}`].filter(Boolean).join(" ");
  }

  #recordedWheel({ name }) {
    return this.#recording?.wheels.find((wheel) => wheel.name === name);
  }

  /** The indicators of the wheel that is looked at, beside those that are held and the recording's. */
  #indicators({ signal, wheel }) {
    const values = (rows) => new Map((rows ?? []).map(([name, , value]) => [name, value]));
    const recorded = this.#recording?.signal.channel.unit;
    const title = recorded === signal.unit ? "recording" : `recording, ${recorded || "no unit"}`;
    const others = [["held", this.#held?.wheel], [title, this.#recordedWheel(wheel)]].filter(([, of]) => of).map(([label, of]) => [label, values(of.indicators)]);
    const rows = (wheel.indicators ?? []).map(([name, unit, value]) => [`${name.replaceAll("_", " ")}${unit === "-" ? "" : `, ${unit}`}`, shown(value), ...others.map(([, known]) => shown(known.get(name)))]);
    table("indicators", ["indicator", "now", ...others.map(([label]) => label)], rows);
    fold(wheel.indicators ?? [], others[0]?.[1] ?? null);
  }

  /** The envelope of a rolling bearing; none where the gearbox has none of these. The lines are the recording's where one is open. */
  #bearing({ signal, bearing, train: { bearings } }) {
    byId("bearing-card").hidden = !bearing;
    if (!bearing) return;
    select("bearing", bearings.filter(({ rolling }) => rolling).map(({ name }) => name), bearing.name);
    const named = this.#recording?.bearing;
    const recorded = named?.name === bearing.name ? named : undefined;
    // Once: what the recording is of may have no such bearing.
    if (named && !recorded && this.#askedAgain !== bearing.name) this.#process();
    this.#askedAgain = bearing.name;
    const looked = recorded ?? bearing;
    const squared = (unit) => (/^\p{L}+$/u.test(unit) ? `${unit}²` : `(${unit})²`);
    const unit = squared(recorded ? this.#recording.signal.channel.unit : signal.unit);
    const lines = looked.lines ?? [];
    const drawn = bearing.spectrum ? this.#beside(signal, line(bearing.name, bearing.spectrum, 0, bearing.step), ({ bearing: of }) =>
      (of?.spectrum && of.name === bearing.name ? [of.spectrum, 0, of.step] : null)) : [];
    this.#plots.envelope.set(drawn, { x: `order of shaft ${bearing.shaft}`, y: `amplitude (${squared(signal.unit)})`, title: `Squared envelope of ${signal.name}`,
      labels: lines.map(([name, order]) => [order, name]), empty: bearing.problem ?? "" });
    const rows = lines.map(([name, ...numbers]) => [name, ...numbers.map((number) => shown(number))]);
    table("defect-lines", [recorded ? "line of the recording" : "line", "order", "found at", `amplitude, ${unit}`, "over the median"], rows,
      (index) => this.#plots.envelope.zoom([Math.max(lines[index][1] - 1, 0), lines[index][1] + 1]));
    const verdict = (of, { verdict: text, problem } = {}) => (text || problem ? `${of}: ${text ?? problem}.` : "");
    byId("bearing-verdict").textContent = [verdict("Verdict", bearing), verdict("Of the recording", recorded ?? {})].filter(Boolean).join(" ");
    byId("bearing-warnings").replaceChildren(...(looked.warnings ?? []).map((warning) => element("li", {}, warning)));
  }
}

function select(id, names, value) {
  const box = byId(id);
  if ([...box.options].map(({ value: name }) => name).join() !== names.join()) box.replaceChildren(...names.map((name) => new Option(name, name)));
  box.value = value;
}

/** Fills a table whose rows have a heading. @param choose is given the number of a row that is chosen */
function table(id, heads, rows, choose = null) {
  const cells = ([name, ...texts]) => element("tr", {}, element("th", { scope: "row" }, name), ...texts.map((text) => element("td", {}, text)));
  const drawn = rows.map(cells);
  if (choose) drawn.forEach((row, index) => row.addEventListener("click", () => choose(index)));
  const head = element("thead", {}, element("tr", {}, ...heads.map((title) => element("th", { scope: "col" }, title))));
  byId(id).replaceChildren(...(rows.length ? [head, element("tbody", {}, ...drawn)] : []));
}

begin((catalogue) => {
  const view = new GearboxView(() => page.change("full"), () => page.process());
  const controls = new GearboxControls(byId("controls"), catalogue, view.asked, (detail) => page.change(detail));
  const page = new Page("gearbox", catalogue, controls, view, "a quarter of a second");
});
