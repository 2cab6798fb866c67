// A recording that was opened, before it is processed: what it looks like, and what its file does not say, which is guessed and confirmed.

import { Newest, unpacked } from "./ask.js";
import { Plot, line, shown } from "./plots.js";

const byId = (id) => document.getElementById(id);
const fields = () => [...document.querySelectorAll("#desk [data-field]")];
const field = (name) => document.querySelector(`#desk [data-field="${name}"]`);

export class Desk {
  #question;
  #status;
  #newest = new Newest("desk");
  #file = null;
  #plots = null;
  #confirm = () => {};

  /**
   * @param question gives the page's scenario, as a request has it
   * @param refuse is told what no field helps against
   * @param status is told what is under way
   */
  constructor(question, refuse, status) {
    [this.#question, this.#status] = [question, status];
    byId("desk").addEventListener("change", ({ target }) => {
      // Another tachometer has other pulses.
      if (target === field("tachometer")) field("pulses_per_revolution").value = "";
      this.#look().catch(refuse);
    });
    byId("desk-use").addEventListener("click", () => this.#end(this.#stated()));
    byId("desk-cancel").addEventListener("click", () => this.#end(null));
  }

  /** Shows a file until it is confirmed; one of a simulation says all itself. @returns what was stated, or null where it is not used */
  async open(file) {
    this.#end(null);
    this.#file = file;
    for (const input of fields()) {
      if (input.tagName === "SELECT") input.replaceChildren();
      input.value = input.placeholder = "";
    }
    const said = await this.#look();
    if (!said) return null;
    if (said.is_simulated) return { name: file.name };
    return new Promise((resolve) => {
      this.#confirm = resolve;
    });
  }

  #end(stated) {
    byId("desk").hidden = true;
    this.#file = null;
    this.#confirm(stated);
    this.#confirm = () => {};
  }

  /** What stands in the fields; what is empty is not stated. */
  #stated() {
    const filled = fields().filter(({ value }) => value !== "");
    const value = (input) => (input.type === "number" ? Number(input.value) : input.value);
    return { name: this.#file.name, ...Object.fromEntries(filled.map((input) => [input.dataset.field, value(input)])) };
  }

  /** Asks what the file looks like with what is stated, and shows it. */
  async #look() {
    const file = this.#file;
    this.#status("reading…");
    // What is still asked is not known yet.
    byId("desk-use").disabled = true;
    // What is looked at of the simulation has another channel.
    const buffer = await this.#newest.ask({ ...this.#question(), channel: undefined, ...this.#stated() }, file);
    if (!buffer || file !== this.#file) return null;
    const said = unpacked(buffer);
    if (!said.is_simulated) this.#show(said);
    this.#status(said.problem ? "not read yet" : "read");
    return said;
  }

  #show(said) {
    const wasHidden = byId("desk").hidden;
    byId("desk").hidden = false;
    if (wasHidden) byId("desk").scrollIntoView({ block: "start" });
    for (const name of ["channel", "tachometer", "pulses_per_revolution", "unit"]) field(name).parentElement.hidden = Boolean(said.problem);
    byId("desk-use").disabled = Boolean(said.problem);
    byId("desk-problem").textContent = said.problem ?? "";
    byId("desk-plots").hidden = Boolean(said.problem);
    byId("desk-title").textContent = said.problem ? "A recording that does not say all" : `${said.name}: is this right?`;
    if (said.problem) {
      byId("desk-said").textContent = "";
      byId("desk-warnings").replaceChildren();
      return;
    }
    const { channels, guess, signal, spectrum, teeth, warnings } = said;
    const names = channels.map(({ name }) => name);
    this.#choose("channel", names.map((name) => [name, name]), guess.channel);
    // An empty tachometer is stated as none.
    this.#choose("tachometer", [["", "none: the scenario's speed"], ...names.map((name) => [name, name])], guess.tachometer ?? "");
    if (field("pulses_per_revolution").value === "") field("pulses_per_revolution").value = guess.pulses_per_revolution;
    field("sampling_rate_hz").placeholder = said.sampling_rate_hz;
    field("unit").placeholder = signal.unit ?? "not stated";
    const wheels = teeth.map(({ wheel, teeth: count }) => `${wheel} ${count}`).join(", ");
    const pulses = field("tachometer").value && said.pulses_hz ? `${field("tachometer").value} gives ${shown(said.pulses_hz)} pulses/s, so that the input turns at ${
      shown(said.pulses_hz / field("pulses_per_revolution").value)} Hz, and in the scenario at ${shown(said.speed_hz)} Hz; ` : "";
    byId("desk-said").textContent = `${names.length} channels, ${shown(said.duration_s)} s at ${said.sampling_rate_hz} S/s by ${said.rate_by}; ${
      pulses}teeth of the scenario: ${wheels}`;
    byId("desk-warnings").replaceChildren(...warnings.map((text) => Object.assign(document.createElement("li"), { textContent: text })));
    const plot = (options) => {
      const place = Object.assign(document.createElement("div"), { className: "plot" });
      byId("desk-plots").append(place);
      return new Plot(place, options);
    };
    this.#plots ??= [
      plot({ title: "First second", x: "time (s)", y: "signal" }),
      plot({ title: "Spectrum", x: "frequency (Hz)", y: "amplitude" }),
    ];
    const unit = signal.unit ?? "unit not stated";
    this.#plots[0].set([line(guess.channel, signal.values, signal.start_s, 1 / said.sampling_rate_hz, "recorded")], { y: `signal (${unit})` });
    this.#plots[1].set([line(guess.channel, spectrum.values, 0, spectrum.step_hz, "recorded")], { y: `amplitude (${unit})` });
  }

  /** Offers choices, of which what the user chose stays. */
  #choose(name, choices, guessed) {
    const select = field(name);
    const chosen = select.options.length > 0 && choices.some(([value]) => value === select.value) ? select.value : guessed;
    select.replaceChildren(...choices.map(([value, text]) => new Option(text, value, false, value === chosen)));
  }
}
