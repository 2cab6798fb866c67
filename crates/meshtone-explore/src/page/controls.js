// The scenario's keys as controls: made from the program's own descriptions, with its units, ranges and words.

/** On a phone the controls stand above what they change, and are folded at first. */
export const isNarrow = matchMedia("(max-width: 800px)").matches;
/** Sections in the order in which they are shown, with what is seen of them at first. */
const SECTIONS = [
  { name: "gears", title: "Gears", open: true, first: ["module_mm", "pinion_teeth", "gear_teeth", "face_width_mm", "pressure_angle_deg"] },
  { name: "operation", title: "Operation", open: true, first: ["pinion_speed_hz", "brake_torque_nm"] },
  { name: "quality", title: "Quality", first: ["din_grade", "iso_class", "seed"] },
  { name: "fault", title: "Damage", open: true },
  { name: "rig", title: "Structure", first: ["damping_ratio", "mesh_damping_ratio", "bearing_stiffness_n_per_m", "brake_inertia_kgm2", "misalignment_um"] },
  { name: "sensor", title: "Sensors" },
  { name: "solver", title: "Solver", first: ["sampling_rate_hz", "pinion_revolutions", "settle_fraction"] },
  { name: "", title: "Model", first: ["model", "seed"] },
];
const UNIT_ENDING = /_(mm|um|deg|rad|hz|nm|g|s|n|n_per_m|nm_per_rad|kgm2|kg|percent|per_cent)$/;
/** From here on a slider is logarithmic. */
const LARGE = 1e3;
/** The keys that a profile over time begins from, and rows of it that are shown. */
const NOMINAL = { speed_profile_hz: "pinion_speed_hz", torque_profile_nm: "brake_torque_nm" };
const MOST_ROWS = 60;

export const words = (key) => key.replace(UNIT_ENDING, "").replaceAll("_", " ");

export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key in made && key !== "list") made[key] = value;
    else made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

/** What stands at a path of a tree; undefined where nothing does. */
export function at(tree, path) {
  return path.reduce((part, key) => (part === undefined || part === null ? undefined : part[key]), tree);
}

/** The key of a path, as the program names it. */
export function keyOf(path) {
  return path.reduce((text, part) => (typeof part === "number" ? `${text}[${part}]` : text ? `${text}.${part}` : part), "");
}

/** The values that a slider goes through: as far as the program allows, and about as far around a value as one looks. */
function rangeOf(description, value) {
  let [least, most] = description.bounds;
  const whole = description.kind === "whole";
  // A key with two near bounds has them: an angle goes all the way round.
  const isNear = least !== null && most !== null && most - least <= 1e3;
  const size = Math.abs(value) || Math.abs(Number(description.default)) || 0;
  const isLog = !whole && size >= LARGE && (least ?? 0) >= 0;
  if (isLog) return { isLog, least: Math.max(least ?? 0, size / 20), most: Math.min(most ?? Infinity, size * 20) };
  const around = isNear ? Math.max(-least, most) : whole ? Math.max(4 * size, 12) : size ? 3 * size : { mm: 1, "µm": 50, "": 1, "-": 1, deg: 10 }[description.unit] ?? 10;
  // Where the key may have either sign, as far to the one side as to the other.
  if (least === null || (least < 0 && -least > 4 * around)) least = -around;
  if (most === null || most > 4 * around) most = around;
  if (least < 0 && most > 0 && !whole) [least, most] = [Math.max(least, -Math.max(-least, most)), Math.min(most, Math.max(-least, most))];
  // A bound that is no value itself.
  const step = whole ? 1 : 10 ** Math.floor(Math.log10((most - least) / 200));
  if (description.allowed.startsWith(">")) least += step;
  if (/< \S+$|, < /.test(description.allowed)) most -= step;
  return { isLog, least: whole ? Math.ceil(least) : least, most: whole ? Math.floor(most) : most, step };
}

class Slider {
  constructor(label, description, moved, released) {
    this.description = description;
    this.input = element("input", { type: "range", "aria-label": label });
    this.range = null;
    this.isAnew = false;
    this.isHeld = false;
    this.shown = null;
    this.input.hidden = true;
    this.input.addEventListener("input", () => moved(this.value));
    this.input.addEventListener("change", () => (this.isHeld ? moved : released)(this.value));
    // A key that is held down moves: each of its steps would take the place of the answer to the one before.
    this.input.addEventListener("keydown", ({ repeat }) => { this.isHeld = repeat; });
    ["keyup", "blur"].forEach((name) => this.input.addEventListener(name, () => {
      if (!this.isHeld) return;
      this.isHeld = false;
      released(this.value);
    }));
  }

  #look(value) {
    this.range = rangeOf(this.description, value);
    const { isLog, least, most, step } = this.range;
    Object.assign(this.input, isLog ? { min: 0, max: 1, step: 0.002 } : { min: least, max: most, step });
  }

  get value() {
    const { isLog, least, most } = this.range;
    const place = Number(this.input.value);
    if (isLog) return Number((least * (most / least) ** place).toPrecision(3));
    return Number(place.toPrecision(10));
  }

  set value(value) {
    if (value === this.shown && !this.isAnew) return;
    this.shown = value;
    this.input.hidden = typeof value !== "number" || !Number.isFinite(value);
    if (this.input.hidden) return;
    if (!this.range || this.isAnew || value < this.range.least - 1e-9 || value > this.range.most + 1e-9) this.#look(value);
    this.isAnew = false;
    const { isLog, least, most } = this.range;
    this.input.value = isLog ? Math.log(value / least) / Math.log(most / least) : value;
    this.input.setAttribute("aria-valuetext", `${value} ${this.description.unit}`);
  }
}

/** One key. */
export class Control {
  constructor(controls, path, description) {
    // What is shown first takes the place of what stands in the field, also where that has the focus.
    Object.assign(this, { controls, path, description, isAnew: true });
    const key = keyOf(path);
    const id = `key-${key}`;
    const label = words(String(path[path.length - 1]));
    const unit = description.unit === "-" ? "" : description.unit;
    const explanation = [description.meaning + (unit ? `, in ${unit}` : ""), description.allowed && `Allowed: ${description.allowed}.`,
      description.default && `Default: ${description.default}.`].filter(Boolean).join(". ").replace("..", ".");
    this.field = this.#field(id);
    this.problem = element("p", { className: "problem", id: `${id}-problem`, hidden: true });
    this.field.setAttribute("aria-describedby", `${id}-explanation ${id}-problem`);
    this.row = element("div", { className: "control", title: explanation },
      element("div", { className: "row" }, element("label", { htmlFor: id }, label),
        element("span", {}, this.field, element("span", { className: "unit" }, unit ? ` ${unit}` : ""))),
      element("span", { id: `${id}-explanation`, className: "hidden" }, explanation));
    this.row.dataset.key = key;
    if (["number", "whole"].includes(description.kind)) {
      const change = (detail) => (value) => {
        this.field.value = value;
        this.slider.shown = null;
        this.controls.set(this.path, value, detail);
      };
      this.slider = new Slider(`${label}${unit ? `, ${unit}` : ""}`, description, change("coarse"), change("full"));
      this.row.append(this.slider.input);
    }
    this.ignored = element("p", { className: "note", hidden: true });
    this.row.append(this.ignored, this.problem);
  }

  #field(id) {
    const { kind, names, default: otherwise } = this.description;
    if (kind === "name") {
      const field = element("select", { id }, ...names.map((name) => element("option", { value: name }, name || "none")));
      field.addEventListener("change", () => this.controls.set(this.path, field.value, "full"));
      return field;
    }
    const field = element("input", { id, type: "text", placeholder: /^[-\d.e]*$/.test(otherwise) ? "" : otherwise.replaceAll("`", "") });
    if (["number", "whole"].includes(kind)) field.inputMode = "decimal";
    field.addEventListener("change", () => this.controls.set(this.path, this.#typed(field.value.trim()), "full"));
    return field;
  }

  /** What was typed, as a value where it is one: what is none is for the program to refuse. */
  #typed(text) {
    const { kind } = this.description;
    const number = (part) => (part !== "" && Number.isFinite(Number(part)) ? Number(part) : part);
    if (text === "") return undefined;
    if (kind === "text") return text;
    const parts = text.replace(/^\[|\]$/g, "").split(",").map((part) => number(part.trim()));
    if (parts.length > 1 || (kind === "numbers" && text.startsWith("["))) return parts;
    return parts[0];
  }

  show(value, model) {
    const text = value === undefined || value === null ? "" : Array.isArray(value) ? value.join(", ") : String(value);
    const isTyping = document.activeElement === this.field && !this.isAnew;
    if (!isTyping && this.field.value !== text) this.field.value = text;
    this.isAnew = false;
    if (this.slider && document.activeElement !== this.slider.input) this.slider.value = value;
    const isIgnored = this.description.ignored_by.includes(model);
    this.row.classList.toggle("ignored", isIgnored);
    this.ignored.hidden = !isIgnored;
    this.ignored.textContent = isIgnored ? `has no effect in the model ${model}` : "";
  }

  refuse(text) {
    this.problem.textContent = text ?? "";
    this.problem.hidden = !text;
    if (text) this.field.setAttribute("aria-invalid", "true");
    else this.field.removeAttribute("aria-invalid");
  }
}

/** A quantity over time: a table of its points. */
class Profile {
  #box;
  #table;
  #rest;
  #points = null;

  constructor(controls, path, description) {
    Object.assign(this, { controls, path, description });
    const key = keyOf(path);
    const id = `key-${key}`;
    const label = words(path.at(-1));
    this.#box = element("input", { type: "checkbox", id, "aria-describedby": `${id}-problem` });
    this.#box.addEventListener("change", () => this.#set(this.#box.checked ? this.#constant() : undefined));
    this.#table = element("table", { className: "points", "aria-label": label });
    this.#rest = element("p", { className: "note", hidden: true });
    this.problem = element("p", { className: "problem", id: `${id}-problem`, hidden: true });
    this.row = element("div", { className: "control", title: `${description.meaning}. Allowed: ${description.allowed}.` },
      element("label", {}, this.#box, ` ${label}`), this.#table, this.#rest, this.problem);
    this.row.dataset.key = key;
  }

  /** The nominal value from the start to the end. */
  #constant() {
    const nominal = this.controls.tree[this.path[0]][NOMINAL[this.path.at(-1)]];
    return { time_s: [0, this.controls.end_s], value: [nominal, nominal] };
  }

  #set(points) {
    this.#points = points;
    this.controls.set(this.path, points, "full");
  }

  /** Puts points in place of some. */
  #splice(at, removed, ...added) {
    const time_s = this.#points.time_s.toSpliced(at, removed, ...added.map(([time]) => time));
    this.#set({ time_s, value: this.#points.value.toSpliced(at, removed, ...added.map(([, value]) => value)) });
  }

  /** Between a point and the next one, or as far behind the last as that is behind the one before it. */
  #insert(after) {
    const { time_s: times, value } = this.#points;
    const isLast = after + 1 === times.length;
    const [time, level] = isLast ? [2 * times[after] - (times[after - 1] ?? times[after] - 1), value[after]]
      : [(times[after] + times[after + 1]) / 2, (value[after] + value[after + 1]) / 2];
    const rounded = (number) => (Number.isFinite(number) ? Number(number.toPrecision(6)) : "");
    this.#splice(after + 1, 0, [rounded(time), rounded(level)]);
  }

  show(points, model) {
    this.#box.checked = Boolean(points);
    const rows = Math.min(points?.time_s.length ?? 0, MOST_ROWS);
    if (rows !== this.#table.rows.length - 1) this.#build(rows);
    this.#points = points && { time_s: [...points.time_s], value: [...points.value] };
    for (let row = 0; row < rows; row++) {
      ["time_s", "value"].forEach((name, column) => {
        const field = this.#field(row, column);
        const text = String(points[name][row]);
        if (field.value !== text && document.activeElement !== field) field.value = text;
      });
    }
    const more = (points?.time_s.length ?? 0) - rows;
    this.#rest.textContent = `and ${more} more: in the scenario as text`;
    this.#rest.hidden = more === 0;
    this.row.classList.toggle("ignored", this.description.ignored_by.includes(model));
  }

  #field(row, column) {
    return this.#table.rows[row + 1].cells[column].firstChild;
  }

  #build(rows) {
    const units = this.description.unit.split(", ");
    const label = words(this.path.at(-1));
    const number = (row, column, name) => {
      const field = element("input", { type: "text", inputMode: "decimal", "aria-label": `${label}, point ${row + 1}: ${name} in ${units[column]}` });
      field.addEventListener("change", () => {
        const text = field.value.trim();
        const typed = text !== "" && Number.isFinite(Number(text)) ? Number(text) : text;
        const point = [this.#points.time_s[row], this.#points.value[row]];
        point[column] = typed;
        this.#splice(row, 1, point);
      });
      return element("td", {}, field);
    };
    const button = (text, said, act) => {
      const made = element("button", { type: "button", "aria-label": said, title: said }, text);
      made.addEventListener("click", act);
      return made;
    };
    const head = element("tr", {}, element("th", { scope: "col" }, `time, ${units[0]}`), element("th", { scope: "col" }, `value, ${units[1]}`), element("td"));
    this.#table.replaceChildren(...(rows ? [head] : []), ...Array.from({ length: rows }, (_, row) =>
      element("tr", {}, number(row, 0, "time"), number(row, 1, "value"), element("td", {},
        button("+", `Insert a point after point ${row + 1}`, () => this.#insert(row)),
        button("−", `Remove point ${row + 1}`, () => this.#splice(row, 1))))));
  }

  /** @param key what the words are about: this, or a number in it */
  refuse(text, key = "") {
    this.problem.textContent = text ?? "";
    this.problem.hidden = !text;
    this.row.querySelectorAll("[aria-invalid]").forEach((field) => field.removeAttribute("aria-invalid"));
    if (!text) return;
    const [, name, row] = /\.(time_s|value)\[(\d+)\]$/.exec(key) ?? [];
    const isShown = name && Number(row) < this.#table.rows.length - 1;
    (isShown ? this.#field(Number(row), name === "value" ? 1 : 0) : this.#box).setAttribute("aria-invalid", "true");
  }
}

export class Controls {
  #form;
  #catalogue;
  #changed;
  #controls = new Map();
  #groups = new Map();
  #answer = null;
  #shape = "";
  #refused = null;
  tree = {};

  /**
   * @param catalogue the sections of a scenario with their keys, and the kinds of damage with an example each
   * @param changed called with "coarse" while a control moves and with "full" once it is set
   */
  constructor(form, catalogue, changed) {
    this.#form = form;
    this.#catalogue = catalogue;
    this.#changed = changed;
    form.addEventListener("submit", (event) => event.preventDefault());
  }

  /** Another scenario: its sections and keys. */
  open(tree) {
    this.tree = structuredClone(tree);
    for (const list of ["fault", "sensor"]) {
      const entries = this.tree[list] ?? [];
      this.tree[list] = Array.isArray(entries) ? entries : [entries];
    }
    this.#answer = null;
    this.#shape = "";
    this.#controls.forEach((control) => {
      control.isAnew = true;
      if (control.slider) control.slider.isAnew = true;
    });
  }

  /** (s) About where the signal ends. */
  get end_s() {
    const given = this.tree.solver?.duration_s;
    if (given) return given;
    if (!this.#answer) return 1;
    const { start_s: start, values, sampling_rate_hz: rate } = this.#answer.signal;
    return Number((start + values.length / rate).toPrecision(2));
  }

  /** What is sent: lists that are empty are left out. */
  get scenario() {
    return Object.fromEntries(Object.entries(this.tree).filter(([, value]) => !Array.isArray(value) || value.length));
  }

  /** Sets a key, or takes it away. */
  set(path, value, detail) {
    // A control of what has been removed stands until the answer to that comes.
    if (typeof path[1] === "number" && !this.tree[path[0]][path[1]]) return;
    if (path[0] === "fault" && path.length > 2) this.#settle(path);
    let part = this.tree;
    path.slice(0, -1).forEach((key, index) => {
      if (typeof part[key] !== "object" || part[key] === null) part[key] = typeof path[index + 1] === "number" ? [] : {};
      part = part[key];
    });
    const last = path[path.length - 1];
    if (value === undefined) delete part[last];
    else part[last] = value;
    this.#changed(detail);
  }

  /** A severity stands in place of a fault's sizes, or they in place of it. */
  #settle([, index, key]) {
    const fault = this.tree.fault[index];
    const sizes = this.#kind(fault).sizes;
    if (key === "severity") {
      sizes.forEach((size) => delete fault[size]);
      delete fault.circle;
    } else if (sizes.includes(key) && fault.severity !== undefined) {
      this.tree.fault[index] = { ...(this.#answer?.sized_faults[index] ?? fault) };
      delete this.tree.fault[index].severity;
    }
  }

  #kind(fault) {
    return this.#catalogue.kinds.find(({ name }) => name === fault.kind) ?? this.#catalogue.kinds[0];
  }

  /** Shows the values of an answer. */
  show(answer) {
    this.#answer = answer;
    const entries = (list) => [list ?? []].flat();
    const full = { ...answer.scenario, fault: entries(answer.scenario.fault), sensor: entries(answer.scenario.sensor) };
    const shape = JSON.stringify([full.fault.map(({ kind }) => kind), full.sensor.length]);
    if (shape !== this.#shape) this.#build(full);
    this.#shape = shape;
    for (const control of this.#controls.values()) control.show(this.#value(control.path, full), full.model);
    this.refuse(null);
  }

  #value(path, full) {
    const own = at(full, path);
    if (path[0] !== "fault" || own !== undefined) return own;
    if (path[2] === "severity") return Number(this.#answer.severities[path[1]].toPrecision(3));
    return at(this.#answer.sized_faults, path.slice(1));
  }

  /** Shows a refusal at the key that it is about. @returns whether it has a place here */
  refuse(details) {
    this.#refused?.refuse(null);
    this.#refused = null;
    if (!details?.key) return false;
    const key = details.key.replace(/^(fault|sensor)(?=\.|$)/, "$1[0]");
    const keys = [...this.#controls.keys()].filter((known) => key === known || key.startsWith(`${known}[`) || key.startsWith(`${known}.`));
    const found = this.#controls.get(keys.sort((a, b) => b.length - a.length)[0]);
    this.#refused = found;
    found?.refuse([details.problem, details.help].filter(Boolean).join("; "), details.key);
    for (let around = found?.row.closest("details"); around; around = around.parentElement.closest("details")) around.open = true;
    return Boolean(found);
  }

  #build(full) {
    const focused = document.activeElement?.id;
    const open = new Map([...this.#groups].map(([name, group]) => [name, group.open]));
    this.#controls.clear();
    this.#groups.clear();
    this.#form.replaceChildren(...SECTIONS.map((section) => {
      const listed = this.#catalogue.sections.find(({ name }) => name === section.name);
      const group = element("details", { className: "group", open: open.get(section.name) ?? (Boolean(section.open) && !isNarrow) },
        element("summary", {}, section.title));
      this.#groups.set(section.name, group);
      if (section.name === "fault") group.append(...this.#faults(full.fault));
      else if (section.name === "sensor") group.append(...this.#sensors(full.sensor, listed.keys));
      else group.append(...this.#section(section, listed.keys));
      return group;
    }));
    if (focused) document.getElementById(focused)?.focus();
  }

  #section(section, keys) {
    const base = section.name ? [section.name] : [];
    const more = element("details", { className: "more", open: false }, element("summary", {}, "More"));
    const first = section.first.map((name) => keys.find(({ key }) => key === name)).filter(Boolean);
    const rest = keys.filter((key) => !first.includes(key));
    more.append(...this.#fields(base, rest));
    return [...this.#fields(base, first), ...(rest.length ? [more] : [])];
  }

  /** The controls of keys; those inside a table stand together. */
  #fields(base, keys) {
    const tables = new Map();
    const fields = [];
    for (const description of keys) {
      const { key, kind } = description;
      const [table, ...inside] = key.split(".");
      if (kind === "value" || kind === "file") continue;
      // What is inside a list of tables is in the scenario as text.
      if (inside.length && keys.some((other) => other.key === table && other.kind === "value")) continue;
      if (kind === "profile") {
        fields.push(this.#add([...base, key], description, Profile));
        continue;
      }
      if (kind === "table") {
        const set = element("fieldset", { title: description.meaning }, element("legend", {}, words(key)));
        tables.set(key, set);
        fields.push(set);
      } else if (inside.length && tables.has(table)) {
        tables.get(table).append(this.#add([...base, table, ...inside], description));
      } else {
        fields.push(this.#add([...base, ...key.split(".")], description));
      }
    }
    return fields.filter((field) => field.tagName !== "FIELDSET" || field.children.length > 1 || field.querySelector("input"));
  }

  #add(path, description, Kind = Control) {
    const control = new Kind(this, path, description);
    this.#controls.set(keyOf(path), control);
    return control.row;
  }

  #faults(faults) {
    const place = this.#catalogue.sections.find(({ name }) => name === "fault").keys;
    const sets = faults.map((fault, index) => {
      const kind = this.#kind(fault);
      const choice = element("select", { "aria-label": `Kind of damage ${index + 1}` },
        ...this.#catalogue.kinds.map(({ name }) => element("option", { value: name, selected: name === fault.kind }, words(name.replaceAll("-", "_")))));
      choice.addEventListener("change", () => {
        const example = this.#catalogue.kinds.find(({ name }) => name === choice.value).example;
        // Teeth that nobody chose are those that the new kind is usually on: wear is on all, other damage on one.
        const usual = JSON.stringify(fault.tooth) === JSON.stringify(kind.example.tooth);
        this.tree.fault[index] = { ...example, wheel: fault.wheel, tooth: usual ? example.tooth : fault.tooth };
        this.#changed("full");
      });
      const remove = element("button", { type: "button", "aria-label": `Remove damage ${index + 1}` }, "Remove");
      remove.addEventListener("click", () => {
        this.tree.fault.splice(index, 1);
        this.#changed("full");
      });
      // A pit is given by its edges or by a circle: by a circle where the scenario has one.
      const keys = kind.keys.filter(({ key }) => (fault.circle ? !kind.sizes.includes(key) || key.startsWith("circle") : !key.startsWith("circle")));
      const places = place.filter(({ key }) => kind.sizes.length || key !== "severity");
      return element("fieldset", {}, element("legend", {}, `Damage ${index + 1}`), element("div", { className: "row" }, choice, remove),
        element("p", { className: "note" }, kind.summary),
        ...this.#fields(["fault", index], [...places, ...keys]));
    });
    const kinds = element("select", { "aria-label": "Kind of damage to add" },
      ...this.#catalogue.kinds.map(({ name }) => element("option", { value: name }, words(name.replaceAll("-", "_")))));
    const add = element("button", { type: "button", id: "add-fault" }, "Add damage");
    add.addEventListener("click", () => {
      const example = structuredClone(this.#catalogue.kinds.find(({ name }) => name === kinds.value).example);
      // Beside what there is, where a tooth has room for one alone.
      if (example.tooth === 1) example.tooth = 1 + this.tree.fault.length;
      this.tree.fault.push(example);
      this.#changed("full");
    });
    return [...sets, element("div", { className: "row" }, kinds, add)];
  }

  #sensors(sensors, keys) {
    const sets = sensors.map((_, index) => {
      const remove = element("button", { type: "button", "aria-label": `Remove sensor ${index + 1}` }, "Remove");
      remove.addEventListener("click", () => {
        this.tree.sensor.splice(index, 1);
        this.#changed("full");
      });
      return element("fieldset", {}, element("legend", {}, `Sensor ${index + 1}`), remove, ...this.#fields(["sensor", index], keys));
    });
    const add = element("button", { type: "button", id: "add-sensor" }, "Add sensor");
    add.addEventListener("click", () => {
      // Two that are alike would have one name.
      this.tree.sensor.push(this.tree.sensor.length ? { name: `sensor_${this.tree.sensor.length + 1}` } : {});
      this.#changed("full");
    });
    return [...sets, element("div", { className: "row" }, add)];
  }
}
