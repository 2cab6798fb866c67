// The train of a gearbox from the front and from above, in which a wheel or a mesh is chosen.

const SVG = "http://www.w3.org/2000/svg";
/** Free room around the train, as a part of its size. */
const ROOM = 0.06;
/** Revolutions a second of the fastest wheel while the train is turned. */
const TURNED_HZ = 0.25;
/** Width of a letter over the size of its text. */
const LETTER = 0.6;
/** Thickness of a ring's rim over the size of the picture. */
const RIM = 0.05;

function made(name, attributes, ...children) {
  const node = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

/** What can be chosen, with pointer and keyboard. */
function choosable(name, isChosen, label, choose, ...children) {
  const group = made("g", { class: `${name}${isChosen ? " chosen" : ""}`, role: "button", tabindex: 0, "aria-pressed": isChosen, "aria-label": label }, ...children);
  group.addEventListener("click", choose);
  group.addEventListener("keydown", (event) => {
    if (!["Enter", " "].includes(event.key)) return;
    event.preventDefault();
    choose();
  });
  return group;
}

/** Shows shapes as large as they fit. @param corners [x, y] that must be seen */
function fit(svg, corners, children) {
  const [xs, ys] = [0, 1].map((axis) => corners.map((corner) => corner[axis]));
  const [left, right, top, bottom] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const room = ROOM * Math.max(right - left, bottom - top);
  svg.setAttribute("viewBox", [left - room, top - room, right - left + 2 * room, bottom - top + 2 * room].join(" "));
  svg.replaceChildren(...children);
}

/** The middle of the longest part of a shaft that nothing covers, or a place behind its end where a name of some width has no room there. @param covered [from, to] each */
function freePlace({ start_mm: start, length_mm: length, radius_mm: radius }, covered, width) {
  const inside = (place) => Math.min(Math.max(place, start), start + length);
  let [free, from] = [[start, start], start];
  for (const [next, end] of [...covered.sort(([a], [b]) => a - b), [start + length, start + length]]) {
    if (inside(next) - from > free[1] - free[0]) free = [from, inside(next)];
    from = Math.max(from, inside(end));
  }
  return free[1] - free[0] < width ? start + length + radius + width / 2 : (free[0] + free[1]) / 2;
}

const textAt = (x, y, size, text) => made("text", { x, y, "font-size": size, "text-anchor": "middle", "dominant-baseline": "central" }, text);

export class Train {
  #front;
  #above;
  #chooseWheel;
  #chooseMesh;
  #chooseBearing;
  /** What turns in the picture: nodes, each with the function that makes its transform of the input's revolutions. */
  #moving = [];
  /** Turned a little at first: a first tooth, which is often the damaged one, would be hidden where its wheel meets another. */
  #input = 0.3;
  #inputHz = 0;
  #isTurning = false;

  /** @param chooseWheel, chooseMesh, chooseBearing called with a name */
  constructor(front, above, chooseWheel, chooseMesh, chooseBearing) {
    [this.#front, this.#above, this.#chooseWheel, this.#chooseMesh, this.#chooseBearing] = [front, above, chooseWheel, chooseMesh, chooseBearing];
  }

  /** @param train as the program says it; names of the wheel, the mesh and the rolling bearing that are looked at */
  show(train, { wheel, mesh, bearing }) {
    // What has the focus keeps it: its place is drawn anew.
    const focused = document.activeElement?.closest?.(".train g")?.getAttribute("aria-label");
    this.#fromTheFront(train, wheel, mesh);
    this.#fromAbove(train, wheel, bearing);
    if (focused) [...document.querySelectorAll(".train g")].find((group) => group.getAttribute("aria-label") === focused)?.focus();
  }

  /** Turns the picture, or stops it. @returns whether it turns */
  turn() {
    this.#isTurning = !this.#isTurning;
    let last = null;
    const next = (now) => {
      if (!this.#isTurning) return;
      this.#input += ((now - (last ?? now)) / 1000) * this.#inputHz;
      last = now;
      this.#place();
      requestAnimationFrame(next);
    };
    if (this.#isTurning) requestAnimationFrame(next);
    return this.#isTurning;
  }

  #place() {
    this.#moving.forEach(([node, at]) => node.setAttribute("transform", at(this.#input)));
  }

  /** Lets a node turn about a point with the input's revolutions. */
  #turns(node, ratio, [x, y]) {
    this.#moving.push([node, (input) => `rotate(${(-360 * ratio * input) % 360} ${x} ${y})`]);
    return node;
  }

  #fromTheFront({ shafts, wheels, meshes }, chosen, chosenMesh) {
    this.#moving = [];
    this.#inputHz = TURNED_HZ / Math.max(...wheels.map(({ ratio }) => Math.abs(ratio)));
    const centre = ({ x_mm: x, y_mm: y }) => [x, -y];
    const size = Math.max(...wheels.map(({ pitch_radius_mm: radius }) => radius));
    // Names are in front; a planet takes its own along.
    const names = [];
    const carried = (node, { carrier }) => (carrier ? this.#turns(node, carrier.ratio, centre(carrier)) : node);
    const named = (wheel, [x, y], text, height) => {
      const node = this.#turns(textAt(x, y, height, text), -(wheel.carrier?.ratio ?? 0), [x, y]);
      names.push(carried(made("g", {}, node), wheel));
    };
    const meeting = ({ wheels: [a, b] }) => {
      const [from, to] = [centre(wheels[a]), centre(wheels[b])];
      const mate = (wheels[b].internal ? -1 : 1) * wheels[b].pitch_radius_mm;
      const part = wheels[a].pitch_radius_mm / (wheels[a].pitch_radius_mm + mate);
      return [0, 1].map((axis) => from[axis] + part * (to[axis] - from[axis]));
    };
    const circles = wheels.map((wheel, index) => {
      const { name, teeth, damaged, sense, internal, in_set: inSet, ratio, carrier, pitch_radius_mm: radius } = wheel;
      const [x, y] = centre(wheel);
      // A dash a tooth. The first stands where the wheel first meets another; the next in contact follow behind it.
      const dash = (Math.PI * radius) / teeth;
      const [meetX, meetY] = meeting(meshes.find((mesh) => mesh.wheels.includes(index)));
      const first = Math.atan2(meetY - y, meetX - x);
      const arc = (tooth) => {
        const middle = first + (sense * 2 * Math.PI * (tooth - 1)) / teeth;
        const [from, to] = [-1, 1].map((side) => middle + (side * Math.PI) / (2 * teeth)).map((angle) => [x + radius * Math.cos(angle), y + radius * Math.sin(angle)]);
        return made("path", { d: `M ${from} A ${radius} ${radius} 0 0 1 ${to}`, class: "tooth", "stroke-width": size * 0.1 });
      };
      const toothed = made("g", {}, made("circle", { cx: x, cy: y, r: radius, class: "teeth", "stroke-dasharray": dash, "stroke-dashoffset": dash / 2 - first * radius, "stroke-width": size * 0.04 }),
        ...damaged.map(arc));
      const text = `${name} · ${teeth}`;
      const rim = internal ? [made("circle", { cx: x, cy: y, r: radius + size * RIM, class: "body" })] : [];
      const body = [...rim, made("circle", { cx: x, cy: y, r: radius, class: internal ? "hole" : "body" }),
        this.#turns(toothed, ratio - (carrier?.ratio ?? 0), [x, y])];
      // Beside a small wheel there is more room than in it.
      if (internal) names.push(textAt(x, y - radius - size * 0.14, size * 0.11, text));
      else if (inSet) named(wheel, [x, y + (carrier ? 0 : radius * 0.4)], text, Math.min(size * 0.11, (1.8 * radius) / (LETTER * text.length)));
      else names.push(textAt(x, y - (radius < 0.5 * size ? radius + size * 0.1 : radius * 0.72), size * 0.11, text));
      return carried(choosable("wheel", name === chosen, `wheel ${name}, ${teeth} teeth${damaged.length ? ", damaged" : ""}`, () => this.#chooseWheel(name), ...body), wheel);
    });
    // Of two wheels on one shaft the smaller is seen before the larger.
    const order = wheels.map((_, index) => index).sort((a, b) => wheels[b].pitch_radius_mm - wheels[a].pitch_radius_mm);
    const isHere = ({ x_mm: x, y_mm: y }, shaft) => Math.hypot(x - shaft.x_mm, y - shaft.y_mm) < 1e-3 * size;
    const below = shafts.map((shaft, number) => {
      const onAxis = wheels.filter((wheel) => isHere(wheel, shaft)).map(({ pitch_radius_mm: radius, internal }) => radius + (internal ? size * RIM : 0));
      // The names of shafts on one axis stand below one another.
      const before = shafts.slice(0, number).filter((other) => isHere(other, shaft)).length;
      return Math.max(0, ...onAxis) + size * (0.13 + 0.13 * before);
    });
    const axes = shafts.map(({ name, x_mm: x, y_mm: y, radius_mm: radius, speed_hz: speed, sense }, number) => {
      const arc = radius * 2;
      const arrow = sense > 0 ? `M ${x + arc} ${-y} A ${arc} ${arc} 0 0 0 ${x} ${-y - arc} l ${arc * 0.35} ${-arc * 0.3} m ${-arc * 0.35} ${arc * 0.3} l ${arc * 0.35} ${arc * 0.3}`
        : `M ${x - arc} ${-y} A ${arc} ${arc} 0 0 1 ${x} ${-y - arc} l ${-arc * 0.35} ${-arc * 0.3} m ${arc * 0.35} ${arc * 0.3} l ${-arc * 0.35} ${arc * 0.3}`;
      return made("g", { class: "shaft" }, made("circle", { cx: x, cy: -y, r: radius }), made("path", { d: arrow, class: "turn" }),
        textAt(x, -y + below[number], size * 0.1, `${name} ${Number(speed.toPrecision(4))} Hz`));
    });
    const points = meshes.map((mesh) => {
      const { name, wheels: [a, b], frequency_hz: hz } = mesh;
      const [x, y] = meeting(mesh);
      return carried(choosable("mesh", name === chosenMesh, `mesh ${name}, ${Number(hz.toPrecision(4))} Hz`, () => this.#chooseMesh(name),
        made("circle", { cx: x, cy: y, r: size * (wheels[a].in_set ? 0.05 : 0.08) })), [wheels[a], wheels[b]].find(({ carrier }) => carrier) ?? {});
    });
    const corners = wheels.flatMap((wheel) => [-1, 1].map((sign) => centre(wheel).map((place) => place + sign * (wheel.pitch_radius_mm + size * 0.15))));
    corners.push(...shafts.map((shaft, number) => [shaft.x_mm, -shaft.y_mm + below[number] + size * 0.05]));
    fit(this.#front, corners, [...order.map((index) => circles[index]), ...axes, ...points, ...names]);
    this.#place();
  }

  #fromAbove({ shafts, wheels, bearings }, chosen, chosenBearing) {
    const first = Math.min(...shafts.map(({ start_mm: start }) => start));
    const last = Math.max(...shafts.map(({ start_mm: start, length_mm: length }) => start + length));
    const size = last - first;
    const names = [];
    const lines = shafts.map((shaft) => {
      const { name, x_mm: x, radius_mm: radius, start_mm: start, length_mm: length } = shaft;
      const faces = wheels.filter(({ x_mm: axis, pitch_radius_mm: reach }) => Math.abs(axis - x) < reach).map(({ z_mm: z, face_width_mm: width }) => [z - width / 2, z + width / 2]);
      const seats = bearings.filter(({ x_mm: axis }) => axis === x).map(({ z_mm: z, shaft: of }) => [-1, 1].map((side) => z + side * 0.5 * (shafts[of]?.radius_mm ?? 0)));
      names.push(textAt(freePlace(shaft, [...faces, ...seats], LETTER * size * 0.035 * name.length), x, size * 0.035, name));
      return made("g", { class: "shaft" }, made("rect", { x: start, y: x - radius, width: length, height: 2 * radius }));
    });
    const supports = bearings.map(({ name, shaft, x_mm: x, z_mm: z, rolling, damaged }) => {
      // A planet's has no shaft of its own.
      const radius = shafts[shaft]?.radius_mm ?? size * 0.01;
      const square = made("rect", { class: "bearing", x: z - radius * 0.5, y: x - radius * 1.6, width: radius, height: radius * 3.2 });
      if (!rolling) return square;
      return choosable(`rolling${damaged ? " damaged" : ""}`, name === chosenBearing, `rolling bearing ${name}${damaged ? ", damaged" : ""}`, () => this.#chooseBearing(name), square);
    });
    const taken = [];
    const faces = wheels.map(({ name, damaged, teeth, internal, in_set: inSet, x_mm: x, z_mm: z, face_width_mm: width, pitch_radius_mm: radius }) => {
      const face = (from, height) => made("rect", { class: "body", x: z - width / 2, y: x + from, width, height });
      const rim = size * RIM;
      const at = x - (internal ? radius + 1.8 * rim : inSet ? 0 : radius * 0.6);
      // Of planets behind one another one is named.
      const isFree = !taken.some(([otherZ, otherAt]) => Math.abs(otherZ - z) < width && Math.abs(otherAt - at) < size * 0.04);
      taken.push([z, at]);
      if (isFree) names.push(textAt(z, at, size * 0.045, name));
      return choosable(`wheel${damaged.length ? " damaged" : ""}`, name === chosen, `wheel ${name} from above, ${teeth} teeth`, () => this.#chooseWheel(name),
        ...(internal ? [face(-radius - rim, rim), face(radius, rim)] : [face(-radius, 2 * radius)]));
    });
    const corners = [[first, 0], [last, 0], ...wheels.flatMap(({ x_mm: x, pitch_radius_mm: radius }) => [-1, 1].map((sign) => [first, x + sign * (radius + 2 * size * RIM)]))];
    fit(this.#above, corners, [...lines, ...faces, ...supports, ...names]);
  }
}
