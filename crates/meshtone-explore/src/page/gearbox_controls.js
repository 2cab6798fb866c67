// Controls of a gearbox: the lists of its scenario, with what a bearing of a kind can have.

import { Control, at, element, isNarrow, keyOf, words } from "./controls.js";

const byId = (id) => document.getElementById(id);
/** Sections in the order in which they are shown. */
const SECTIONS = [["operation", "Operation", true], ["fault", "Damage", true], ["wheel", "Wheels"], ["mesh", "Meshes"], ["planetary", "Planetary sets"], ["shaft", "Shafts"],
  ["bearing", "Bearings"], ["housing", "Housing"], ["sensor", "Sensors"], ["solver", "Solver"], ["", "Seed and material"]];
const LISTS = ["shaft", "wheel", "mesh", "planetary", "bearing", "fault", "sensor"];
/** Kinds of keys that have a control; the rest is in the scenario as text. */
const SHOWN_KINDS = ["number", "whole", "name", "text", "teeth"];
/** Keys of a bearing that state its size, and all that only rolling bearings have. */
const BEARING_SIZES = ["elements", "element_mm", "pitch_mm", "contact_angle_deg"];
const OF_ROLLING = ["name", ...BEARING_SIZES, "roller_length_mm", "clearance_um", "preload_n", "slip_percent", "defect"];

export class GearboxControls {
  #form;
  #catalogue;
  #asked;
  #changed;
  #controls = new Map();
  #open = new Map();
  #shape = "";
  #refused = null;
  tree = {};

  /** @param asked what the page looks at: damage is added to that wheel, and a bearing with a new defect is looked at */
  constructor(form, catalogue, asked, changed) {
    [this.#form, this.#catalogue, this.#asked, this.#changed] = [form, catalogue, asked, changed];
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

  show({ scenario: full }) {
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
    const group = element("details", { className: "group", open: this.#open.get(name) ?? (isOpen && !isNarrow) }, element("summary", {}, title));
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
      this.#asked.bearing = `${shaft}:${at}`;
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
    const spoken = (kind) => kind.replaceAll("-", " ");
    const choice = (label, names, value, set, said = (name) => name) => {
      const select = element("select", { "aria-label": label }, ...names.map((name) => element("option", { value: name, selected: name === value }, said(name))));
      select.addEventListener("change", () => set(select.value));
      return select;
    };
    const ofSet = ({ name, planets, planet_angles_deg: angles = [] }) =>
      ["sun", ...Array.from({ length: angles.length || planets }, (_, index) => `planet${index + 1}`), "ring"].map((member) => `${name}.${member}`);
    const wheels = [...full.wheel.map(({ name }) => name), ...full.planetary.flatMap(ofSet)];
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
      const keys = [...places.filter(({ key }) => key === "tooth" || (key === "severity" && fault.severity !== undefined) || (key === "flank" && /\.planet\d+$/.test(fault.wheel))), ...ofKind];
      return element("fieldset", {}, element("legend", {}, `Damage ${index + 1}`), element("div", { className: "row" },
        choice(`Wheel of damage ${index + 1}`, wheels, fault.wheel, (wheel) => this.set(["fault", index, "wheel"], wheel, "full")),
        choice(`Kind of damage ${index + 1}`, kinds, fault.kind, (name) => put(index, example(fault.wheel, name)), spoken), remove),
        element("p", { className: "note" }, kind.summary), ...this.#fields(["fault", index], keys));
    });
    const added = choice("Kind of damage to add", kinds, kinds[0], () => {}, spoken);
    const add = element("button", { type: "button", id: "add-fault" }, "Add damage");
    add.addEventListener("click", () => {
      this.tree.fault.push(example(this.#asked.wheel ?? wheels[0], added.value));
      this.#changed("full");
    });
    return [...sets, element("div", { className: "row" }, added, add)];
  }
}
