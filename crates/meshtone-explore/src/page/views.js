// What is seen of an answer: figures, mesh cycle, signal, revolution, indicators.

import { fold } from "./indicators.js";
import { Plot, forgetColours, line, shown } from "./plots.js";
import { Teeth } from "./teeth.js";

const byId = (id) => document.getElementById(id);
/** Revolutions of the gear that are seen of the signal at first. */
const SEEN_REVOLUTIONS = 3;
/** Mesh orders that are seen of a spectrum at first. */
const SEEN_HARMONICS = 5;
/** Mesh orders that are marked in a spectrum. */
const MARKED_HARMONICS = 40;
const PAIR_LOOKS = ["now", "second", "recorded", "damage"];

/** Changes a text that is another: what stays is not laid out anew. */
function setText(node, text) {
  if (node.data !== text) node.data = text;
}

export class Views {
  #plots;
  #teeth;
  #now = null;
  #held = null;
  #recording = null;
  #severity = null;
  #healthy = null;
  #indicator = "difference_kurtosis";
  #askSeverity;
  #tableShape = "";
  #figureNames = "";
  #warned = "";

  /** @param askSeverity called when another fault's severity is wanted */
  constructor(askSeverity) {
    const plot = (id, options) => new Plot(byId(id), options);
    this.#plots = {
      forces: plot("forces", { title: "Force of each pair", x: "pitches", y: "force (N)" }),
      stiffness: plot("stiffness", { title: "Mesh stiffness over a gear revolution", x: "pitches", y: "stiffness (N/µm)" }),
      waveform: plot("waveform", { title: "Signal", x: "time (s)", y: "signal (g)" }),
      average: plot("average", { title: "Average", x: "angle (°)", y: "signal (g)" }),
      difference: plot("difference", { title: "Difference and its envelope", x: "angle (°)", y: "signal (g)" }),
      spectrum: plot("spectrum", { title: "Spectrum of the average: mesh orders dashed, ▾ modes", x: "order of the shaft", y: "amplitude (g)" }),
      envelopeSpectrum: plot("envelope-spectrum", { title: "Spectrum of the envelope", x: "order of the shaft", y: "amplitude (g)" }),
      severity: plot("severity", { title: "Indicator against severity", x: "severity", y: "", kind: "points" }),
    };
    this.#askSeverity = askSeverity;
    this.#teeth = new Teeth(byId("teeth"), byId("teeth-note"), (turned) => this.#turned(turned));
    byId("play").addEventListener("click", () => this.#play(!this.#teeth.playing));
    byId("teeth").addEventListener("keydown", (event) => this.#keyOfTeeth(event));
    byId("turn").addEventListener("input", ({ target }) => {
      this.#play(false);
      const [from, to] = this.#teeth.span;
      this.#teeth.turnTo(from + ((to - from) * target.value) / 1000);
    });
    byId("whole").addEventListener("change", ({ target }) => {
      this.#teeth.whole = target.checked;
      this.#teeth.draw();
    });
    byId("wheel").addEventListener("change", () => this.#revolution());
    byId("logarithmic").addEventListener("change", () => this.#revolution());
    byId("fault").addEventListener("change", () => this.#askSeverity());
    byId("all-indicators").addEventListener("change", () => this.#indicators());
    this.#play(this.#teeth.playing);
  }

  get fault() {
    return Number(byId("fault").value) || 0;
  }

  get now() {
    return this.#now;
  }

  rest() {
    this.#teeth.rest();
  }

  show(answer) {
    this.#now = answer;
    if (answer.healthy) this.#healthy = answer.healthy;
    else if (answer.detail === "full") this.#healthy = null;
    this.#figures();
    this.#teeth.set(answer.teeth, answer.mesh);
    this.#mesh();
    this.#signal();
    this.#revolution();
    this.#choices();
    this.#indicators();
  }

  hold(answer) {
    this.#held = answer;
    if (this.#now) this.show(this.#now);
  }

  setRecording(recording) {
    this.#recording = recording;
    if (this.#now) this.show(this.#now);
  }

  setHealthy(healthy) {
    this.#healthy = healthy;
    this.#indicators();
  }

  setSeverity(curve) {
    this.#severity = curve;
    this.#drawSeverity();
  }

  /** The theme is another. */
  repaint() {
    forgetColours();
    Object.values(this.#plots).forEach((plot) => plot.repaint());
    this.#teeth.draw();
  }

  togglePlay() {
    this.#play(!this.#teeth.playing);
  }

  #play(playing) {
    this.#teeth.play(playing);
    byId("play").textContent = playing ? "Pause" : "Turn";
    byId("play").setAttribute("aria-pressed", String(playing));
  }

  #keyOfTeeth(event) {
    const step = { ArrowLeft: -0.05, ArrowRight: 0.05 }[event.key];
    if (!step) return;
    event.preventDefault();
    this.#play(false);
    const [from, to] = this.#teeth.span;
    this.#teeth.turnTo(Math.min(Math.max(this.#teeth.turned + step, from), to));
  }

  #turned(turned) {
    const [from, to] = this.#teeth.span;
    byId("turn").value = (1000 * (turned - from)) / (to - from);
    byId("turn").setAttribute("aria-valuetext", `${turned.toFixed(2)} pitches`);
    this.#plots.forces.mark(turned);
    this.#plots.stiffness.mark(turned);
  }

  #figures() {
    const { figures, warnings } = this.#now;
    const list = byId("figures");
    const names = figures.map(([name]) => name).join();
    if (names !== this.#figureNames) {
      list.replaceChildren(...figures.map(([name]) => {
        const row = document.createElement("div");
        row.append(Object.assign(document.createElement("dt"), { textContent: name }), Object.assign(document.createElement("dd"), { textContent: "–" }));
        return row;
      }));
    }
    this.#figureNames = names;
    figures.forEach(([, value, unit], index) => setText(list.children[index].lastChild.firstChild, `${shown(value)}${unit ? ` ${unit}` : ""}`));
    const messages = warnings.map(({ key, message }) => `${key}: ${message}`);
    if (messages.join("\n") === this.#warned) return;
    this.#warned = messages.join("\n");
    byId("warnings").replaceChildren(...messages.map((text) => Object.assign(document.createElement("li"), { textContent: text })));
  }

  #mesh() {
    const { mesh, teeth } = this.#now;
    const held = this.#held?.mesh;
    const bands = this.#damagedPairs(teeth);
    const range = this.#teeth.span;
    const pairs = mesh.pairs.map(({ pair, force_n: force }) => {
      const look = PAIR_LOOKS[((pair % PAIR_LOOKS.length) + PAIR_LOOKS.length) % PAIR_LOOKS.length];
      return line(`pair ${pair + 1}`, force, mesh.forces_from, mesh.forces_step, look);
    });
    this.#plots.forces.set(pairs, { range, bands, empty: "the published model shares no load among pairs" });
    const gearTeeth = teeth.wheels[1].teeth;
    const perPitch = Math.round(1 / mesh.stiffness_step);
    const repeated = Float32Array.from({ length: gearTeeth * mesh.healthy_n_per_um.length },
      (_, k) => mesh.healthy_n_per_um[k % mesh.healthy_n_per_um.length]);
    const lines = [line("this pair", mesh.stiffness_n_per_um, 0, mesh.stiffness_step)];
    if (bands.length) lines.unshift(line("sound", repeated, 0, 1 / perPitch, "held", [4, 3]));
    if (held) lines.unshift(line("held", held.stiffness_n_per_um, 0, held.stiffness_step, "held"));
    this.#plots.stiffness.set(lines, { bands, range: [0, gearTeeth] });
  }

  /** Pitches in which a damaged pair is in contact, or would be. */
  #damagedPairs({ wheels, contact_span_pitches: [before, after] }) {
    const gearTeeth = wheels[1].teeth;
    const bands = [];
    wheels.forEach(({ teeth, damaged }) => damaged.filter(({ numbers }) => damaged.length === 1 || 2 * numbers.length <= teeth).forEach(({ numbers }) => numbers.forEach((number) => {
      for (let pair = number - 1 - teeth; pair <= gearTeeth; pair += teeth) bands.push([pair + before, pair + after]);
    })));
    // All teeth alike: nothing stands out.
    return bands.length > 2 * gearTeeth ? [] : bands;
  }

  #signal() {
    const { signal, scenario, channels } = this.#now;
    if ([...byId("channel").options].map(({ value }) => value).join() !== channels.map(({ name }) => name).join()) {
      byId("channel").replaceChildren(...channels.map(({ name, meaning }) => Object.assign(document.createElement("option"), { value: name, textContent: name, title: meaning })));
    }
    byId("channel").value = signal.channel.name;
    const of = (label, drawn, look, from = drawn.start_s) => line(label, drawn.values, from, 1 / drawn.sampling_rate_hz, look);
    const end = signal.start_s + signal.values.length / signal.sampling_rate_hz;
    const revolution = scenario.gears.gear_teeth / (scenario.gears.pinion_teeth * scenario.operation.pinion_speed_hz);
    const start = Math.max(this.#now.detail === "full" ? signal.start_s : 0, end - SEEN_REVOLUTIONS * revolution);
    const lines = [of("now", signal, "now")];
    if (this.#held) lines.unshift(of("held", this.#held.signal, "held"));
    if (this.#recording) lines.push(of("recording", this.#recording.signal, "recorded", start));
    const unit = signal.channel.unit;
    this.#plots.waveform.set(lines, { range: [start, end], title: signal.channel.meaning ?? signal.channel.name, y: `signal (${unit})` });
  }

  #revolution() {
    if (!this.#now) return;
    const wheel = Number(byId("wheel").value);
    const name = wheel ? "gear" : "pinion";
    const now = this.#now.wheels[wheel];
    const others = [["held", this.#held?.wheels[wheel], "held"], ["recording", this.#recording?.wheels[wheel], "recorded"]];
    const unit = this.#now.signal.channel.unit;
    const all = [...others.slice(0, 1), ["now", now, "now"], ...others.slice(1)].filter(([, drawn]) => drawn?.average);
    const span = this.#now.teeth.contact_span_pitches;
    const few = now.damaged.length < now.teeth;
    const bands = few ? now.damaged.flatMap((number) => {
      const [from, to] = span.map((pitches) => (360 * (number - 1 + pitches)) / now.teeth);
      if (from < 0) return [[0, to], [from + 360, 360]];
      return to > 360 ? [[from, 360], [0, to - 360]] : [[from, to]];
    }) : [];
    const over = (key, look) => all.map(([label, drawn, own]) => line(label, drawn[key], 0, 360 / drawn[key].length, look ?? own));
    const empty = now.problem ?? "";
    const degrees = [0, 360];
    this.#plots.average.set(over("average"), { bands, range: degrees, y: `signal (${unit})`, empty,
      title: now.revolutions ? `Average of ${now.revolutions} ${name} revolutions` : "Average" });
    const envelopes = now.envelope ? [line("envelope", now.envelope, 0, 360 / now.envelope.length, "second")] : [];
    this.#plots.difference.set([...over("difference"), ...envelopes], { bands, range: degrees, y: `signal (${unit})`, empty });
    const orders = (key) => all.map(([label, drawn, look]) => line(label, drawn[key].subarray(1), 1, 1, look));
    const last = (key, most) => [0, Math.min(most, now[key]?.length ?? most)];
    const marks = Array.from({ length: Math.min(MARKED_HARMONICS, Math.floor((now.spectrum?.length ?? 0) / now.teeth)) }, (_, k) => (k + 1) * now.teeth);
    const isLog = byId("logarithmic").checked;
    const modes = this.#modes(wheel);
    const triangles = modes.flatMap(([, places]) => places);
    this.#plots.spectrum.set(orders("spectrum"), { range: last("spectrum", SEEN_HARMONICS * now.teeth), marks, triangles, isLog, y: `amplitude (${unit})`, empty });
    this.#plots.envelopeSpectrum.set(orders("envelope_spectrum"), { range: last("envelope_spectrum", 2 * now.teeth), marks, isLog, y: `amplitude (${unit})`, empty });
    const tinted = bands.length ? `Tinted: damaged ${name} ${now.damaged.length > 1 ? "teeth" : "tooth"} ${now.damaged.join(", ")} in contact.` : "";
    const problem = this.#recording?.wheels[wheel].problem;
    const named = modes.map(([what, , hertz]) => `${what} ${hertz.map((hz) => shown(hz, 3)).join(", ")}`);
    const ringing = named.length ? `Triangles in the spectrum, in Hz: ${named.join("; ")}.` : "";
    byId("wheel-note").textContent = [tinted, ringing, ...(now.warnings ?? []), problem && `Recording: ${problem}`].filter(Boolean).join(" ");
  }

  /** What rings: its name, its places in orders of a wheel's shaft, in Hz. None where the speed varies. */
  #modes(wheel) {
    const { operation, gears } = this.#now.scenario;
    if (operation.speed_profile_hz) return [];
    const shaft = operation.pinion_speed_hz * (wheel ? gears.pinion_teeth / gears.gear_teeth : 1);
    const all = (this.#now.modes ?? []).filter(([, hertz]) => hertz.length);
    return all.map(([what, hertz]) => [what, hertz.map((hz) => hz / shaft), hertz]);
  }

  /** The faults whose severity can be looked at. */
  #choices() {
    const faults = [this.#now.scenario.fault ?? []].flat();
    const named = faults.map(({ kind, wheel, tooth }) => `${kind.replaceAll("-", " ")}, ${wheel} tooth ${[tooth].flat().join(", ")}`);
    const choice = byId("fault");
    if ([...choice.options].map(({ text }) => text).join() !== named.join()) {
      choice.replaceChildren(...named.map((text, value) => Object.assign(document.createElement("option"), { value, text })));
    }
    byId("fault-choice").hidden = !faults.length;
    if (!faults.length) this.#severity = null;
  }

  #indicators() {
    if (!this.#now) return;
    const wheel = Number(byId("wheel").value);
    const values = (rows) => new Map((rows ?? []).map(([name, , value]) => [name, value]));
    const healthy = values(this.#healthy?.[wheel]);
    const held = this.#held && values(this.#held.wheels[wheel].indicators);
    const recorded = this.#recording && values(this.#recording.wheels[wheel].indicators);
    const rows = this.#now.wheels[wheel].indicators ?? [];
    const shape = [rows.length, Boolean(held), Boolean(recorded)].join();
    if (shape !== this.#tableShape) this.#table(rows, held, recorded);
    this.#tableShape = shape;
    const cells = byId("indicators").tBodies[0].rows;
    rows.forEach(([name, , value], index) => {
      const ratio = value !== null && healthy.get(name) ? value / healthy.get(name) : null;
      const texts = [shown(value), shown(healthy.get(name)), shown(ratio, 3), held && shown(held.get(name)), recorded && shown(recorded.get(name))];
      texts.filter((text) => typeof text === "string").forEach((text, column) => {
        setText(cells[index].cells[column + 1].firstChild, text);
      });
    });
    // A held answer is compared with, else the healthy pair.
    fold(rows, held ?? healthy, this.#indicator);
    this.#drawSeverity();
  }

  /** The rows, whose numbers are still to come. */
  #table(rows, held, recorded) {
    const heads = ["indicator", "now", "healthy", "ratio", ...(held ? ["held"] : []), ...(recorded ? ["recording"] : [])];
    const cell = () => Object.assign(document.createElement("td"), { textContent: "–" });
    const head = document.createElement("thead");
    head.insertRow().append(...heads.map((text) => Object.assign(document.createElement("th"), { textContent: text, scope: "col" })));
    const body = document.createElement("tbody");
    for (const [name, unit] of rows) {
      const row = body.insertRow();
      row.setAttribute("aria-selected", String(name === this.#indicator));
      const choose = Object.assign(document.createElement("button"), { textContent: `${name.replaceAll("_", " ")}${unit === "-" ? "" : `, ${unit}`}`, type: "button" });
      const title = Object.assign(document.createElement("th"), { scope: "row" });
      title.append(choose);
      row.append(title, ...heads.slice(1).map(cell));
      row.addEventListener("click", () => {
        this.#indicator = name;
        body.querySelectorAll("tr").forEach((other) => other.setAttribute("aria-selected", String(other === row)));
        this.#drawSeverity();
      });
    }
    byId("indicators").replaceChildren(head, body);
  }

  #drawSeverity() {
    const curve = this.#severity;
    const found = curve?.indicators.find(({ name }) => name === this.#indicator);
    const words = this.#indicator.replaceAll("_", " ");
    const note = byId("severity-note");
    const plot = this.#plots.severity;
    plot.mark(found ? (this.#now?.severities[curve.fault] ?? null) : null);
    if (!found) {
      plot.set([], { title: `${words} against severity`, empty: "add damage to see its severity" });
      note.textContent = "";
      return;
    }
    const step = curve.severities[1] - curve.severities[0];
    plot.set([line(words, found.values, 0, step)], { range: [-0.03, 1.03], title: `${words} of the ${curve.wheel} against severity`, y: found.unit === "-" ? words : `${words} (${found.unit})` });
    note.textContent = "The line marks what is set; the simulations are as short as those while a control moves.";
  }
}
