// The teeth of both wheels in their plane, turning: which touch, where, and how hard.

import { colour, shown } from "./plots.js";

const TAU = 2 * Math.PI;
/** Pitches a second. */
const SPEED = 0.35;
/** Time between two pictures of the turning wheels, and between two notes of the forces, in ms; a picture waits for the screen too. */
const REST = 24;
const NOTE = 240;
/** How long the wheels stand still at most for an answer that is awaited: what draws them is wanted for it, in ms. */
const STILL = 150;

/** The outline of a tooth and of the root to the next one, in the tooth's own plane: [x, y] from the back foot over the tip. */
function outline(flankX, flankY, workingY, end, halfPitch) {
  const points = [];
  const last = flankX.length - 1;
  for (let k = 0; k <= last && flankX[k] <= end; k++) points.push([flankX[k], -flankY[k]]);
  for (let k = last; k >= 0; k--) if (flankX[k] <= end) points.push([flankX[k], workingY[k]]);
  if (!points.length) {
    const foot = Math.hypot(flankX[0], flankY[0]);
    const angle = Math.atan2(flankY[0], flankX[0]);
    points.push([foot * Math.cos(angle), -foot * Math.sin(angle)], [foot * Math.cos(angle), foot * Math.sin(angle)]);
  }
  const [x, y] = points[points.length - 1];
  const [radius, angle] = [Math.hypot(x, y), Math.atan2(y, x)];
  // Over the root to where the next tooth begins.
  const next = 2 * halfPitch - Math.abs(Math.atan2(points[0][1], points[0][0]));
  for (let k = 1; k < 6; k++) {
    const at = angle + ((next - angle) * k) / 6;
    points.push([radius * Math.cos(at), radius * Math.sin(at)]);
  }
  return points;
}

class Wheel {
  constructor(geometry, centreX, sign) {
    Object.assign(this, { geometry, centreX, sign });
    this.pitch = TAU / geometry.teeth;
    const x = geometry.flank_x_mm;
    const y = geometry.flank_y_mm;
    this.sound = outline(x, y, y, Infinity, this.pitch / 2);
    this.damaged = new Map();
    for (const tooth of geometry.damaged) {
      const points = outline(x, y, tooth.flank_y_mm, tooth.end_x_mm, this.pitch / 2);
      for (const number of tooth.numbers) this.damaged.set(number, { ...tooth, points });
    }
  }

  /** Direction of a tooth's centre line, the wheel having turned by so many pitches. */
  direction(index, turned) {
    return this.geometry.first_tooth_rad + this.sign * this.pitch * (turned - index);
  }

  /** The wheel's teeth that come within a distance of the pitch point, as the first one's index and their number: counter-clockwise. */
  near(turned, distance) {
    const { teeth, pitch_radius_mm: radius } = this.geometry;
    if (distance >= radius) return [0, teeth];
    // A ray from the centre passes the pitch point at this distance.
    const half = Math.asin(distance / radius) / this.pitch;
    const towards = this.sign > 0 ? 0 : Math.PI;
    const middle = (towards - this.direction(0, turned)) / this.pitch;
    const count = Math.min(2 * Math.ceil(half) + 3, teeth);
    return [Math.round(middle) - Math.floor(count / 2), count];
  }

  /** Number of the tooth that stands so many places counter-clockwise of the first one. */
  numberAt(place) {
    const { teeth } = this.geometry;
    return ((((this.sign > 0 ? -place : place) % teeth) + teeth) % teeth) + 1;
  }

  /** What is seen of teeth, and the body within them. */
  paths(turned, [first, count]) {
    const edge = new Path2D();
    for (let place = first; place < first + count; place++) {
      const number = this.numberAt(place);
      const points = this.damaged.get(number)?.points ?? this.sound;
      const angle = this.direction(number - 1, turned);
      const [sin, cos] = [Math.sin(angle), Math.cos(angle)];
      for (let k = 0; k < points.length; k++) {
        const [x, y] = points[k];
        const isFirst = k === 0 && place === first;
        edge[isFirst ? "moveTo" : "lineTo"](this.centreX + x * cos - y * sin, x * sin + y * cos);
      }
    }
    const isWhole = count === this.geometry.teeth;
    if (isWhole) edge.closePath();
    const body = new Path2D(edge);
    // Out of sight, where it is not the whole.
    if (!isWhole) body.lineTo(this.centreX, 0);
    body.closePath();
    const { bore_radius_mm: bore } = this.geometry;
    for (const path of [edge, body]) {
      path.moveTo(this.centreX + bore, 0);
      path.arc(this.centreX, 0, bore, 0, TAU);
    }
    return { edge, body };
  }
}

export class Teeth {
  #canvas;
  #note;
  #geometry = null;
  #wheels = [];
  #mesh = null;
  #turned = 0;
  #playing = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  #frame = 0;
  #last = 0;
  #noted = 0;
  #stillUntil = 0;
  #moved;
  #isSeen = true;
  #size = [0, 0];
  whole = false;

  /** @param moved called with the pitches that the wheels have turned */
  constructor(canvas, note, moved) {
    this.#canvas = canvas;
    this.#note = note;
    this.#moved = moved;
    new ResizeObserver(([{ contentRect }]) => {
      this.#size = [contentRect.width, contentRect.height];
      this.draw();
    }).observe(canvas);
    new IntersectionObserver((entries) => {
      this.#isSeen = entries.at(-1).isIntersecting;
      this.draw();
    }).observe(canvas);
    this.#run();
  }

  get playing() {
    return this.#playing;
  }

  get turned() {
    return this.#turned;
  }

  /** The pitches that are gone through. */
  get span() {
    const points = this.#mesh?.pairs[0]?.force_n.length ?? 0;
    const from = this.#mesh?.forces_from ?? 0;
    return [from, points ? from + points * this.#mesh.forces_step : from + 5];
  }

  play(playing) {
    this.#playing = playing;
    this.draw();
    this.#run();
  }

  /** Another answer is awaited. */
  rest() {
    this.#stillUntil = performance.now() + STILL;
  }

  set(teeth, mesh) {
    this.#stillUntil = 0;
    this.#geometry = teeth;
    this.#mesh = mesh;
    this.#wheels = teeth.wheels.map((wheel, index) => new Wheel(wheel, index * teeth.centre_distance_mm, index ? -1 : 1));
    const [from, to] = this.span;
    if (this.#turned < from || this.#turned > to) this.#turned = from;
    this.draw();
  }

  turnTo(turned) {
    this.#turned = turned;
    this.draw();
    this.#moved(turned);
  }

  #run() {
    if (this.#frame || !this.#playing) return;
    const step = (now) => {
      this.#frame = 0;
      if (!this.#playing) return;
      // Not after a pause: the wheels go on from where they stood.
      const passed = Math.min(now - this.#last, 100) / 1000;
      this.#last = now;
      const [from, to] = this.span;
      if (this.#geometry && this.#isSeen && now > this.#stillUntil) {
        const on = this.#turned + SPEED * passed;
        this.turnTo(on > to ? from : on);
      }
      this.#frame = setTimeout(() => requestAnimationFrame(step), REST);
    };
    this.#frame = requestAnimationFrame(step);
  }

  /** Force of a pair at a turn, in N; null where it is not known. */
  #force(pair) {
    if (!this.#mesh?.pairs.length) return null;
    const row = this.#mesh.pairs.find((entry) => entry.pair === pair);
    const index = Math.round((this.#turned - this.#mesh.forces_from) / this.#mesh.forces_step);
    return row?.force_n[Math.min(Math.max(index, 0), row.force_n.length - 1)] ?? 0;
  }

  /** The pairs on their path, and where. */
  #contacts() {
    const { contact_ratio: ratio, path_start_mm: start, path_per_pitch_mm: step } = this.#geometry;
    const contacts = [];
    for (let pair = Math.floor(this.#turned); this.#turned - pair <= ratio; pair--) {
      const place = this.#turned - pair;
      const force = this.#force(pair);
      contacts.push({ pair, force, at: [start[0] + place * step[0], start[1] + place * step[1]] });
    }
    return contacts;
  }

  draw() {
    const geometry = this.#geometry;
    const [width, height] = this.#size;
    if (!geometry || !this.#isSeen || !width) return;
    const canvas = this.#canvas;
    const ratio = devicePixelRatio || 1;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const context = canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    const [pinion, gear] = geometry.wheels;
    const module = gear.tip_radius_mm / (gear.teeth / 2 + 1);
    const view = this.whole
      ? { x: (geometry.centre_distance_mm + gear.tip_radius_mm - pinion.tip_radius_mm) / 2, y: 0,
          w: geometry.centre_distance_mm + gear.tip_radius_mm + pinion.tip_radius_mm, h: 2 * Math.max(gear.tip_radius_mm, pinion.tip_radius_mm) }
      : { x: pinion.pitch_radius_mm, y: 0, w: 9 * module, h: 9 * module };
    const scale = Math.min(width / view.w, height / view.h) * 0.96;
    context.setTransform(ratio * scale, 0, 0, -ratio * scale, (ratio * width) / 2 - ratio * scale * view.x, (ratio * height) / 2 + ratio * scale * view.y);
    const pixel = 1 / scale;
    const seen = this.whole ? Infinity : Math.hypot(width, height) / scale / 2;
    for (const wheel of this.#wheels) {
      const teeth = wheel.near(this.#turned, seen);
      const { edge, body } = wheel.paths(this.#turned, teeth);
      context.fillStyle = colour(wheel.sign > 0 ? "pinion" : "gear");
      context.fill(body, "evenodd");
      context.strokeStyle = colour("ink");
      context.lineWidth = pixel;
      context.lineJoin = "round";
      context.stroke(edge);
      this.#drawDamage(context, wheel, teeth, pixel);
    }
    this.#drawLine(context, seen, pixel);
    this.#drawContacts(context, pixel, module);
    this.#drawNames(context, ratio, width);
  }

  /** Which wheel is which: the pinion stands on the left. */
  #drawNames(context, ratio, width) {
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.fillStyle = colour("ink");
    context.font = "13px system-ui";
    context.textBaseline = "top";
    for (const [index, side] of ["left", "right"].entries()) {
      context.textAlign = side;
      const { teeth } = this.#geometry.wheels[index];
      context.fillText(`${index ? "gear" : "pinion"}, ${teeth} teeth`, index ? width - 8 : 8, 8);
    }
  }

  /** What is lost of the damaged teeth, and their cracks. */
  #drawDamage(context, wheel, [first, count], pixel) {
    const { flank_x_mm: x, flank_y_mm: y } = wheel.geometry;
    for (let place = first; place < first + count; place++) {
      const number = wheel.numberAt(place);
      const tooth = wheel.damaged.get(number);
      if (!tooth) continue;
      context.save();
      context.translate(wheel.centreX, 0);
      context.rotate(wheel.direction(number - 1, this.#turned));
      context.strokeStyle = colour("damage");
      context.fillStyle = colour("tint");
      context.lineWidth = 1.6 * pixel;
      const lost = new Path2D();
      // The sound working flank and back along what is left of it.
      for (let k = 0; k < x.length; k++) lost[k ? "lineTo" : "moveTo"](x[k], y[k]);
      for (let k = x.length - 1; k >= 0; k--) if (x[k] > tooth.end_x_mm) lost.lineTo(x[k], -y[k]);
      for (let k = x.length - 1; k >= 0; k--) if (x[k] <= tooth.end_x_mm) lost.lineTo(x[k], tooth.flank_y_mm[k]);
      context.fill(lost);
      context.setLineDash([3 * pixel, 3 * pixel]);
      context.stroke(lost);
      context.setLineDash([]);
      if (tooth.chip_x_mm !== null) {
        const chip = new Path2D();
        const inside = [];
        for (let k = 0; k < x.length; k++) if (x[k] >= tooth.chip_x_mm && x[k] <= tooth.end_x_mm) inside.push(k);
        inside.forEach((k, place) => chip[place ? "lineTo" : "moveTo"](x[k], y[k]));
        inside.reverse().forEach((k) => chip.lineTo(x[k], -y[k]));
        chip.closePath();
        context.fill(chip);
        context.stroke(chip);
      }
      if (tooth.crack_mm) {
        context.lineWidth = 2.4 * pixel;
        context.beginPath();
        context.moveTo(...tooth.crack_mm[0]);
        context.lineTo(...tooth.crack_mm[1]);
        context.stroke();
      }
      context.restore();
    }
  }

  /** The path of contact and the pitch circles. */
  #drawLine(context, seen, pixel) {
    const { path_start_mm: start, path_per_pitch_mm: step, contact_ratio: ratio, wheels, centre_distance_mm: distance } = this.#geometry;
    context.strokeStyle = colour("second");
    context.lineWidth = 1.6 * pixel;
    context.beginPath();
    context.moveTo(...start);
    context.lineTo(start[0] + ratio * step[0], start[1] + ratio * step[1]);
    context.stroke();
    context.strokeStyle = colour("muted");
    context.lineWidth = 0.8 * pixel;
    context.setLineDash([6 * pixel, 4 * pixel]);
    wheels.forEach((wheel, index) => {
      // Dashes out of sight take as long.
      const half = seen < wheel.pitch_radius_mm ? Math.asin(seen / wheel.pitch_radius_mm) : Math.PI;
      const towards = index ? Math.PI : 0;
      context.beginPath();
      context.arc(index * distance, 0, wheel.pitch_radius_mm, towards - half, towards + half);
      context.stroke();
    });
    context.setLineDash([]);
  }

  #drawContacts(context, pixel, module) {
    const contacts = this.#contacts();
    const step = this.#geometry.path_per_pitch_mm;
    const length = Math.hypot(...step);
    const whole = contacts.reduce((sum, { force }) => sum + (force ?? 0), 0);
    for (const { at, force } of contacts) {
      if (force === 0) {
        context.strokeStyle = colour("muted");
        context.lineWidth = 1.4 * pixel;
        context.beginPath();
        context.arc(...at, 4 * pixel, 0, TAU);
        context.stroke();
        continue;
      }
      context.fillStyle = colour("now");
      context.beginPath();
      context.arc(...at, 5 * pixel, 0, TAU);
      context.fill();
      if (!force) continue;
      // The force on the gear, as a part of the whole.
      const reach = (1.4 * module * force) / whole / length;
      const [dx, dy] = [step[0] * reach, step[1] * reach];
      context.strokeStyle = colour("now");
      context.lineWidth = 2.4 * pixel;
      context.beginPath();
      context.moveTo(...at);
      context.lineTo(at[0] + dx, at[1] + dy);
      context.stroke();
    }
    const now = performance.now();
    // As often as one can read it.
    if (this.#playing && now - this.#noted < NOTE) return;
    this.#noted = now;
    const words = contacts.filter(({ force }) => force !== 0).map(({ pair, force }) => {
      const numbers = this.#geometry.wheels.map(({ teeth }) => (((pair % teeth) + teeth) % teeth) + 1);
      return `pinion tooth ${numbers[0]} on gear tooth ${numbers[1]}${force === null ? "" : `: ${shown(force, 3)} N`}`;
    });
    this.#note.textContent = words.length ? words.join("; ") : "no teeth touch";
  }
}
