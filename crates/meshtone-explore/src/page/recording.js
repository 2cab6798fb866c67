// A recording that was opened on the page: what is asked about it, and what can be said of it.

import { Newest, unpacked } from "./ask.js";

const byId = (id) => document.getElementById(id);
const CONSTANT_SPEED = "constant speed";

export class OpenedRecording {
  #question;
  #show;
  #refuse;
  #status;
  #opened = null;
  #newest = new Newest("recording");
  #desk;

  /**
   * @param desk asks what a file does not say itself
   * @param question gives the page's scenario, and what of it is looked at, as a request has it
   * @param show is given what the recording shows with what was opened, or null where it is removed, and whether that is as it was
   * @param refuse is told where it cannot be read
   * @param status is told what is under way
   */
  constructor(desk, question, show, refuse, status) {
    [this.#desk, this.#question, this.#show, this.#refuse, this.#status] = [desk, question, show, refuse, status];
  }

  async open(file) {
    try {
      const settings = await this.#desk.open(file);
      if (!settings) return;
      this.#opened = { file, settings };
    } catch (error) {
      this.#refuse(error);
      return;
    }
    await this.process();
  }

  /** Processes it. @param isSame whether it is as it was, and another bearing is looked at: a diagnosis of it still holds */
  async process(isSame = false) {
    if (!this.#opened) return;
    const { file, settings } = this.#opened;
    this.#status("reading…");
    try {
      const buffer = await this.#newest.ask({ ...this.#question(), channel: settings.channel, ...settings }, file);
      if (!buffer) return;
      const processed = unpacked(buffer);
      this.#show(processed, this.#opened, isSame);
      this.#describe(processed);
      this.#refuse(null);
      this.#status(`${processed.name}: ${processed.warnings.length ? "read, with warnings" : "read"}`);
    } catch (error) {
      // What was there before stays; this file was none.
      if (!byId("recording").childElementCount) this.#opened = null;
      this.#refuse(error);
    }
  }

  /** What can be said about it. */
  #describe({ name, turning, warnings, channels, signal }) {
    const box = byId("recording");
    const { settings } = this.#opened;
    const choice = (label, names, chosen, key) => {
      const select = document.createElement("select");
      select.append(...names.map((name) => new Option(name, name, false, name === chosen)));
      select.addEventListener("change", () => {
        settings[key] = select.value === CONSTANT_SPEED ? undefined : select.value;
        this.process();
      });
      const around = document.createElement("label");
      around.append(`${label} `, select);
      return around;
    };
    const remove = Object.assign(document.createElement("button"), { textContent: "Remove recording" });
    remove.addEventListener("click", () => {
      this.#opened = null;
      box.replaceChildren();
      this.#show(null, null);
    });
    const title = Object.assign(document.createElement("span"), { textContent: `Recording ${name}, by ${turning}` });
    const warned = document.createElement("ul");
    warned.className = "warned";
    warned.append(...warnings.map((text) => Object.assign(document.createElement("li"), { textContent: text })));
    box.replaceChildren(title, choice("channel", channels, signal.channel.name, "channel"),
      choice("tachometer", [CONSTANT_SPEED, ...channels], settings.tachometer ?? CONSTANT_SPEED, "tachometer"), remove, warned);
  }
}
