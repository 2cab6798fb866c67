// The page of a gearbox: controls ask, the program answers, train, signal and spectrum show.

import { Answers, Newest, Refusal, start, unpacked } from "./ask.js";
import { Control, at, element, keyOf, words } from "./controls.js";
import { Plot, forgetColours, line, shown } from "./plots.js";
import { held, linked, offer, ofAddress, said, saved } from "./taking.js";
import { Train } from "./train.js";

const byId = (id) => document.getElementById(id);
/** Sections in the order in which they are shown. */
const SECTIONS = [["operation", "Operation", true], ["fault", "Damage", true], ["wheel", "Wheels"], ["mesh", "Meshes"], ["shaft", "Shafts"],
  ["bearing", "Bearings"], ["housing", "Housing"], ["sensor", "Sensors"], ["solver", "Solver"], ["", "Seed and material"]];
const LISTS = ["shaft", "wheel", "mesh", "bearing", "fault", "sensor"];
/** Kinds of keys that have a control; the rest is in the scenario as text. */
const SHOWN_KINDS = ["number", "whole", "name", "text", "teeth"];
/** Keys of a bearing that state its size, and all that only rolling bearings have. */
const BEARING_SIZES = ["elements", "element_mm", "pitch_mm", "contact_angle_deg"];
const OF_ROLLING = ["name", ...BEARING_SIZES, "roller_length_mm", "clearance_um", "preload_n", "slip_percent", "defect"];
/** Revolutions of the input that are seen of a signal at first. */
const SEEN_REVOLUTIONS = 3;

/** For tests and measurements: how many pictures were drawn. */
window.meshtone = { drawn: 0, coarse: 0, last: null };

let chosen = { channel: null, wheel: null, mesh: null, bearing: null };
let now = null;
let shownInFull = null;
let kept = null;

class GearboxControls {
  #form;
  #catalogue;
  #changed;
  #controls = new Map();
  #open = new Map();
  #shape = "";
  #refused = null;
  tree = {};

  constructor(form, catalogue, changed) {
    [this.#form, this.#catalogue, this.#changed] = [form, catalogue, changed];
    form.addEventListener("submit", (event) => event.preventDefault());
  }

  open(tree) {
    this.tree = structuredClone(tree);
    LISTS.forEach((list) => { this.tree[list] = [this.tree[list] ?? []].flat(); });
    this.#shape = "";
  }

  /** What is sent: lists that are empty are left out. */
  get scenario() {
    return Object.fromEntries(Object.entries(this.tree).filter(([, value]) => !Array.isArray(value) || value.length));
  }

  set(path, value, detail) {
    let part = this.tree;
    for (const key of path.slice(0, -1)) {
      // A control of what has been removed stands until the answer to that comes.
      if (typeof key === "number" && !part[key]) return;
      part = part[key] ??= {};
    }
    const last = path.at(-1);
    const before = part[last];
    if (value === undefined) delete part[last];
    else part[last] = value;
    if (path[0] === "bearing" && path.length === 3) this.#settleBearing(part, last, before);
    if (path[2] === "defect") this.#settleDefect(part, last);
    this.#changed(detail);
  }

  /** Keys that a bearing of this kind cannot have. */
  #unused({ kind, name }) {
    if (kind === "linear") return OF_ROLLING;
    const ofKind = kind === "ball" ? ["roller_length_mm"] : ["contact_angle_deg", "preload_n"];
    return ["stiffness_n_per_m", ...ofKind, ...(name ? BEARING_SIZES : []), ...(this.#namesOf(kind).length ? [] : ["name"])];
  }

  #namesOf(kind) {
    return this.#catalogue.bearings.filter((known) => known.kind === kind).map(({ name }) => name);
  }

  /** A bearing has the keys of its kind, and a name or sizes. */
  #settleBearing(bearing, changed, before) {
    if (!["kind", "name"].includes(changed)) return;
    const { bearings } = this.#catalogue;
    const names = this.#namesOf(bearing.kind);
    const had = changed === "name" ? before : bearing.name ?? (bearing.elements ? null : bearings[0].name);
    if (changed === "kind" && names.includes(had)) bearing.name = had;
    else if (!names.includes(bearing.name)) {
      // Of a name that it no longer has, the sizes stay.
      Object.assign(bearing, bearings.find(({ name }) => name === had)?.sizes);
      delete bearing.name;
    }
    this.#unused(bearing).forEach((key) => delete bearing[key]);
  }

  /** A defect has a width or a severity, and one of an element no place. */
  #settleDefect(defect, changed) {
    if (changed === "width_mm") delete defect.severity;
    if (changed === "severity") delete defect.width_mm;
    if (defect.race === "element") delete defect.angle_deg;
  }

  show(full) {
    const entries = (list) => [full[list] ?? []].flat();
    const shape = JSON.stringify(LISTS.map((list) => entries(list).map(({ name, kind, wheels, severity, defect }) => [name, kind, wheels, severity === undefined, defect?.map(({ race }) => race)])));
    const listed = { ...full, ...Object.fromEntries(LISTS.map((list) => [list, entries(list)])) };
    if (shape !== this.#shape) this.#build(listed);
    this.#shape = shape;
    for (const control of this.#controls.values()) control.show(at(listed, control.path), "contact");
    this.refuse(null);
  }

  refuse(details) {
    this.#refused?.refuse(null);
    this.#refused = null;
    if (!details?.key) return;
    const [list] = details.key.split(/[.[]/);
    const key = LISTS.includes(list) && !details.key.startsWith(`${list}[`) ? details.key.replace(list, `${list}[0]`) : details.key;
    this.#refused = this.#controls.get(key);
    this.#refused?.refuse([details.problem, details.help].filter(Boolean).join("; "));
    for (let around = this.#refused?.row.closest("details"); around; around = around.parentElement.closest("details")) around.open = true;
  }

  #build(full) {
    const focused = document.activeElement?.id;
    this.#controls.clear();
    this.#form.replaceChildren(...SECTIONS.map(([name, title, isOpen]) => {
      const keys = this.#catalogue.sections.find((section) => section.name === name).keys;
      const group = this.#group(name, title, isOpen);
      if (name === "fault") group.append(...this.#faults(full, keys));
      else if (LISTS.includes(name)) group.append(...full[name].map((entry, index) => this.#entry(name, index, entry, keys)));
      else if (name === "housing" && !full.housing) group.append(element("p", { className: "note" }, "none: the bearings' seats stand on the ground"));
      else group.append(...this.#fields(name ? [name] : [], keys));
      return group;
    }));
    if (focused) byId(focused)?.focus();
  }

  /** A group that stays open or closed when it is built anew. */
  #group(name, title, isOpen = false) {
    const group = element("details", { className: "group", open: this.#open.get(name) ?? isOpen }, element("summary", {}, title));
    group.addEventListener("toggle", () => this.#open.set(name, group.open));
    return group;
  }

  #entry(list, index, entry, keys) {
    const isRolling = list === "bearing" && entry.kind !== "linear";
    const defects = isRolling ? (entry.defect ?? []) : [];
    const what = isRolling ? [`: ${entry.name ?? entry.kind}`, ...defects.map(({ race }) => `defect ${race}`)].join(", ") : "";
    const title = (list === "bearing" ? null : entry.name) ?? entry.wheels?.join("–") ?? (entry.shaft ? `${entry.shaft} at ${entry.at}` : entry.at);
    const group = this.#group(`${list}[${index}]`, title + what);
    const used = list === "bearing" ? keys.filter(({ key }) => !this.#unused(entry).includes(key)).map((key) => this.#named(key, entry)) : keys;
    const before = isRolling ? used.findIndex(({ key }) => key === "defect") : used.length;
    group.append(...this.#fields([list, index], used.slice(0, before)), ...(isRolling ? this.#defects(index, defects, keys) : []),
      ...this.#fields([list, index], used.slice(before)));
    return group;
  }

  /** The name of a bearing as a choice. */
  #named(description, { kind, name = "" }) {
    if (description.key !== "name") return description;
    return { ...description, kind: "name", names: [...new Set(["", ...this.#namesOf(kind), name])] };
  }

  #defects(index, defects, keys) {
    const change = (...splice) => {
      const bearing = this.tree.bearing[index];
      (bearing.defect ??= []).splice(...splice);
      if (!bearing.defect.length) delete bearing.defect;
      this.#changed("full");
    };
    const otherwise = { width_mm: "by severity", severity: "by width" };
    const inside = keys.filter(({ key }) => key.startsWith("defect.")).map((description) => {
      const key = description.key.slice("defect.".length);
      return { ...description, key, default: otherwise[key] ?? description.default };
    });
    const button = (text, said, act) => {
      const made = element("button", { type: "button", "aria-label": said }, text);
      made.addEventListener("click", act);
      return made;
    };
    const sets = defects.map(({ race }, number) => element("fieldset", {}, element("legend", {}, `Defect ${number + 1}`),
      ...this.#fields(["bearing", index, "defect", number], inside.filter(({ key }) => key !== "angle_deg" || race !== "element")),
      button("Remove", `Remove defect ${number + 1} of this bearing`, () => change(number, 1))));
    // A spall in the load zone, of a usual width.
    const add = button("Add defect", "Add a defect to this bearing", () => {
      const { shaft, at } = this.tree.bearing[index];
      chosen.bearing = `${shaft}:${at}`;
      change(defects.length, 0, { race: "outer", width_mm: 1 });
    });
    return [...sets, add];
  }

  #fields(base, keys) {
    const tables = new Map();
    const fields = [];
    for (const description of keys) {
      const [table, ...inside] = description.key.split(".");
      if (description.kind === "table") tables.set(table, element("fieldset", { title: description.meaning }, element("legend", {}, words(table))));
      // What is inside a list of tables is in the scenario as text.
      if (!SHOWN_KINDS.includes(description.kind) || (inside.length && !tables.has(table))) continue;
      const control = new Control(this, [...base, ...description.key.split(".")], description);
      this.#controls.set(keyOf(control.path), control);
      if (!inside.length) fields.push(control.row);
      else if (tables.get(table).append(control.row), !fields.includes(tables.get(table))) fields.push(tables.get(table));
    }
    return fields;
  }

  #faults(full, places) {
    const choice = (label, names, value, set) => {
      const select = element("select", { "aria-label": label }, ...names.map((name) => element("option", { value: name, selected: name === value }, name)));
      select.addEventListener("change", () => set(select.value));
      return select;
    };
    const wheels = full.wheel.map(({ name }) => name);
    const kinds = this.#catalogue.kinds.map(({ name }) => name);
    const kindOf = (name) => this.#catalogue.kinds.find((kind) => kind.name === name);
    const example = (wheel, kind) => ({ wheel, kind, tooth: kindOf(kind).example.tooth ?? 1, ...(kindOf(kind).sizes.length ? { severity: 0.5 } : {}) });
    const put = (index, fault) => {
      this.tree.fault.splice(index, 1, ...(fault ? [fault] : []));
      this.#changed("full");
    };
    const sets = full.fault.map((fault, index) => {
      const kind = kindOf(fault.kind);
      const remove = element("button", { type: "button", "aria-label": `Remove damage ${index + 1}` }, "Remove");
      remove.addEventListener("click", () => put(index, null));
      const ofKind = fault.severity === undefined ? kind.keys : [];
      const keys = [...places.filter(({ key }) => key === "tooth" || (key === "severity" && fault.severity !== undefined)), ...ofKind];
      return element("fieldset", {}, element("legend", {}, `Damage ${index + 1}`), element("div", { className: "row" },
        choice(`Wheel of damage ${index + 1}`, wheels, fault.wheel, (wheel) => this.set(["fault", index, "wheel"], wheel, "full")),
        choice(`Kind of damage ${index + 1}`, kinds, fault.kind, (name) => put(index, example(fault.wheel, name))), remove),
        element("p", { className: "note" }, kind.summary), ...this.#fields(["fault", index], keys));
    });
    const added = choice("Kind of damage to add", kinds, kinds[0], () => {});
    const add = element("button", { type: "button", id: "add-fault" }, "Add damage");
    add.addEventListener("click", () => {
      this.tree.fault.push(example(chosen.wheel ?? wheels[0], added.value));
      this.#changed("full");
    });
    return [...sets, element("div", { className: "row" }, added, add)];
  }
}

function status(text) {
  byId("status").textContent = text;
}

function showProblem(error) {
  byId("problem").hidden = !error;
  byId("views").classList.toggle("stale", Boolean(error));
  if (!error) return;
  if (!(error instanceof Refusal)) throw error;
  controls.refuse(error.details);
  byId("problem").textContent = [error.details.text, error.details.help].filter(Boolean).join("; ");
  status("not computed");
}

const plot = (id, options) => new Plot(byId(id), options);
const plots = {
  waveform: plot("waveform", { title: "Signal", x: "time (s)", y: "signal (g)" }),
  spectrum: plot("spectrum", { title: "Spectrum (dashed: harmonics of the selected mesh)", x: "frequency (Hz)", y: "amplitude (g)" }),
  average: plot("average", { title: "Average of the signal", x: "angle (°)", y: "signal (g)" }),
  envelope: plot("envelope", { title: "Squared envelope", x: "order of the shaft", y: "amplitude (g²)" }),
  force: plot("force", { title: "Force", x: "time (s)", y: "force (N)" }),
};
const train = new Train(byId("front"), byId("above"), (wheel) => look({ wheel }), (mesh) => look({ mesh }), (bearing) => look({ bearing }));

/** Looks at another channel, wheel, mesh or bearing. */
function look(other) {
  chosen = { ...chosen, ...other };
  change("full");
}

function select(id, names, value) {
  const box = byId(id);
  if ([...box.options].map(({ value: name }) => name).join() !== names.join()) box.replaceChildren(...names.map((name) => new Option(name, name)));
  box.value = value;
}

function drawSpectrum({ signal, spectrum, lines, train: { meshes }, mesh }) {
  const { frequency_hz: hz } = meshes.find(({ name }) => name === mesh.name);
  const most = spectrum.step_hz * (spectrum.values.length - 1);
  const marks = Array.from({ length: Math.floor(most / hz) }, (_, index) => (index + 1) * hz);
  plots.spectrum.set([...heldLine(signal, kept?.spectrum.values, 0, kept?.spectrum.step_hz), line(signal.name, spectrum.values, 0, spectrum.step_hz)], { y: `amplitude (${signal.unit})`, marks, isLog: byId("logarithmic").checked });
  const head = element("thead", {}, element("tr", {}, ...["line", "frequency, Hz", `amplitude, ${signal.unit}`].map((title) => element("th", { scope: "col" }, title))));
  const rows = lines.map(([frequency, amplitude, name]) => element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, shown(frequency, 5)), element("td", {}, shown(amplitude, 3))));
  rows.forEach((row, index) => row.addEventListener("click", () => plots.spectrum.zoom([Math.max(lines[index][0] - 0.3 * hz, 0), lines[index][0] + 0.3 * hz])));
  byId("lines").replaceChildren(...(rows.length ? [head, element("tbody", {}, ...rows)] : []));
  byId("lines-note").textContent = rows.length ? `The strongest ${rows.length} lines, each within ${shown(spectrum.step_hz, 3)} Hz of what it is named after. Choose one to see it.`
    : "Lines have names where speed and load are steady.";
}

/** The held line of a signal, where one of its unit is held. */
function heldLine(signal, values, from, step) {
  return values && kept.signal.unit === signal.unit ? [line("held", values, from, step, "held")] : [];
}

/** The indicators of the wheel that is looked at, beside those that are held. */
function drawIndicators({ wheel: { indicators } }) {
  const held = kept && new Map((kept.wheel.indicators ?? []).map(([name, , value]) => [name, value]));
  const heads = ["indicator", "now", ...(held ? ["held"] : [])];
  const row = ([name, unit, value]) => element("tr", {}, element("th", { scope: "row" }, `${name.replaceAll("_", " ")}${unit === "-" ? "" : `, ${unit}`}`),
    element("td", {}, shown(value)), ...(held ? [element("td", {}, shown(held.get(name)))] : []));
  byId("indicators").replaceChildren(element("thead", {}, element("tr", {}, ...heads.map((title) => element("th", { scope: "col" }, title)))),
    element("tbody", {}, ...(indicators ?? []).map(row)));
}

/** The envelope of a rolling bearing; none where the gearbox has none of these. */
function drawBearing({ signal, bearing, train: { bearings } }) {
  byId("bearing-card").hidden = !bearing;
  if (!bearing) return;
  select("bearing", bearings.filter(({ rolling }) => rolling).map(({ name }) => name), bearing.name);
  const lines = bearing.lines ?? [];
  const unit = /^\p{L}+$/u.test(signal.unit) ? `${signal.unit}²` : `(${signal.unit})²`;
  const labels = lines.map(([name, order]) => [order, name]);
  plots.envelope.set(bearing.spectrum ? [line(bearing.name, bearing.spectrum, 0, bearing.step)] : [], { x: `order of shaft ${bearing.shaft}`, y: `amplitude (${unit})`,
    title: `Squared envelope of ${signal.name}`, labels, empty: bearing.problem ?? "" });
  const head = element("thead", {}, element("tr", {}, ...["line", "order", "found at", `amplitude, ${unit}`, "over the median"].map((title) => element("th", { scope: "col" }, title))));
  const rows = lines.map(([name, ...numbers]) => element("tr", {}, element("th", { scope: "row" }, name), ...numbers.map((number) => element("td", {}, shown(number)))));
  rows.forEach((row, index) => row.addEventListener("click", () => plots.envelope.zoom([Math.max(lines[index][1] - 1, 0), lines[index][1] + 1])));
  byId("defect-lines").replaceChildren(...(rows.length ? [head, element("tbody", {}, ...rows)] : []));
  byId("bearing-verdict").textContent = bearing.verdict ? `Verdict: ${bearing.verdict}.` : "";
  byId("bearing-warnings").replaceChildren(...(bearing.warnings ?? []).map((warning) => element("li", {}, warning)));
}

function show(answer, asked) {
  now = answer;
  const { signal, wheel, mesh, train: parts } = answer;
  chosen = { ...chosen, channel: signal.name, wheel: wheel.name, mesh: mesh.name };
  controls.show(answer.scenario);
  select("channel", answer.channels, signal.name);
  select("wheel", parts.wheels.map(({ name }) => name), wheel.name);
  select("mesh", parts.meshes.map(({ name }) => name), mesh.name);
  byId("figures").replaceChildren(...answer.figures.map(([name, value, unit]) => element("div", {}, element("dt", {}, name), element("dd", {}, `${shown(value)} ${unit}`))));
  byId("warnings").replaceChildren(...answer.warnings.map(({ key, message }) => element("li", {}, `${key}: ${message}`)));
  const isFull = answer.detail === "full";
  // While a control moves, too little is simulated for it.
  if (isFull) {
    drawBearing(answer);
    shownInFull = answer;
  }
  train.show(parts, { wheel: wheel.name, mesh: mesh.name, bearing: byId("bearing").value });
  const step = 1 / signal.sampling_rate_hz;
  const seen = [signal.start_s, signal.start_s + Math.min(SEEN_REVOLUTIONS / parts.shafts[0].speed_hz, signal.values.length * step)];
  plots.waveform.set([...heldLine(signal, kept?.signal.values, kept?.signal.start_s, 1 / kept?.signal.sampling_rate_hz), line(signal.name, signal.values, signal.start_s, step)], { y: `signal (${signal.unit})`, range: seen });
  drawSpectrum(answer);
  const { average } = wheel;
  byId("wheel-title").textContent = `Over a revolution of ${wheel.name}, ${wheel.teeth} teeth`;
  const before = kept?.wheel.average;
  plots.average.set(average ? [...heldLine(signal, before?.values, 0, 360 / before?.values.length), line(signal.name, average.values, 0, 360 / average.values.length)] : [],
    { y: `signal (${signal.unit})`, title: average ? `Average over ${average.revolutions} revolutions` : "Average", empty: "needs a steady speed and a whole revolution" });
  byId("mesh-title").textContent = `Force of mesh ${mesh.name}`;
  const force = kept ? [line("held", kept.mesh.force, kept.signal.start_s, 1 / kept.signal.sampling_rate_hz, "held")] : [];
  plots.force.set([...force, line(mesh.name, mesh.force, signal.start_s, step, "second")], { range: seen });
  if (isFull) drawIndicators(answer);
  if (document.activeElement !== byId("toml")) byId("toml").value = answer.toml;
  status(`${shown(performance.now() - asked, 3)} ms${isFull ? "" : ", a quarter of a second"}`);
  showProblem(null);
  window.meshtone.drawn += isFull ? 1 : 0;
  window.meshtone.coarse += isFull ? 0 : 1;
  window.meshtone.last = { asked, detail: answer.detail };
  document.dispatchEvent(new CustomEvent("drawn", { detail: answer.detail }));
}

function change(detail) {
  status(detail === "coarse" ? "…" : "computing…");
  answers.ask({ scenario: controls.scenario, detail, ...chosen });
}

/** Opens a scenario by its file's text. @returns the refusal, where there is one */
async function openText(toml) {
  const asked = performance.now();
  try {
    const buffer = await new Newest("gearbox").ask({ toml, detail: "full", ...chosen });
    if (!buffer) return null;
    const answer = unpacked(buffer);
    answers.forget();
    controls.open(answer.scenario);
    show(answer, asked);
    return null;
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    return error.details;
  }
}

function open(tree) {
  controls.open(tree);
  chosen = { channel: null, wheel: null, mesh: null, bearing: null };
  change("full");
}

function hold() {
  kept = held(byId("hold"), Boolean(shownInFull)) ? shownInFull : null;
  if (shownInFull === now) show(now, performance.now());
}

async function take(file) {
  if (!file) return;
  const refused = await openText(await file.text());
  if (refused) showProblem(new Refusal({ ...refused, text: `${file.name}: ${refused.text}`, key: null }));
}

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  forgetColours();
  Object.values(plots).forEach((drawn) => drawn.repaint());
}

function listen() {
  for (const name of ["channel", "wheel", "mesh", "bearing"]) byId(name).addEventListener("change", ({ target }) => look({ [name]: target.value }));
  byId("logarithmic").addEventListener("change", () => now && drawSpectrum(now));
  byId("theme").addEventListener("click", () => setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
  byId("file").addEventListener("change", ({ target }) => take(target.files[0]));
  byId("file").parentElement.addEventListener("keydown", ({ key }) => ["Enter", " "].includes(key) && byId("file").click());
  offer(byId("preset"), catalogue.presets, open);
  byId("hold").addEventListener("click", hold);
  byId("link").addEventListener("click", () => said(status, showProblem, linked(controls.scenario)));
  document.querySelectorAll("[data-export]").forEach((button) => button.addEventListener("click", () => said(status, showProblem, saved(button.dataset.export, controls.scenario))));
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("input, select, textarea, button, summary, label")) return;
    if (event.key === "h") hold();
  });
  addEventListener("hashchange", () => {
    const tree = ofAddress(showProblem);
    if (tree) open(tree);
  });
  byId("apply").addEventListener("click", async () => {
    const refused = await openText(byId("toml").value);
    byId("toml-problem").textContent = refused ? [refused.text, refused.help].filter(Boolean).join("; ") : "";
  });
  for (const [name, isOver] of [["dragover", true], ["dragleave", false], ["drop", false]]) {
    document.addEventListener(name, (event) => {
      event.preventDefault();
      document.body.classList.toggle("dropping", isOver);
      if (name === "drop") take(event.dataTransfer.files[0]);
    });
  }
}

setTheme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
const catalogue = await start();
const controls = new GearboxControls(byId("controls"), catalogue, change);
const answers = new Answers(show, showProblem, "gearbox");
listen();
open(ofAddress(showProblem) ?? catalogue.scenario);
