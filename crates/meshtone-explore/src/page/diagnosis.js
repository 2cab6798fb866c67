// The diagnosis of the opened recording by the page's scenario: what is seen at once, progress, the answer.

import { Refusal, diagnosis } from "./ask.js";

const byId = (id) => document.getElementById(id);
const element = (name, properties) => Object.assign(document.createElement(name), properties);
const paragraph = (textContent, className = "") => element("p", { textContent, className });

export class Diagnosis {
  #desk;
  #question;
  #refused;
  #recording = null;
  #healthy = null;
  #abort = null;
  /** The rig that is or was diagnosed, as text; null where none was. */
  #diagnosed = null;

  /**
   * @param desk asks what a file does not say itself
   * @param question gives the page's scenario, as a request has it
   * @param refused is told where the healthy recording cannot be read
   * @param records least, usual and largest number of simulations
   */
  constructor(desk, question, refused, [least, usual, most]) {
    [this.#desk, this.#question, this.#refused] = [desk, question, refused];
    Object.assign(byId("records"), { min: least, max: most, step: least, value: usual });
    byId("diagnose").addEventListener("click", () => this.#diagnose());
    byId("stop").addEventListener("click", () => this.#stop("stopped; the batches of simulations that are finished are kept"));
    byId("healthy-file").addEventListener("change", ({ target }) => {
      if (target.files[0]) this.#openHealthy(target.files[0]);
      target.value = "";
    });
    byId("healthy-file").parentElement.addEventListener("keydown", ({ key }) => ["Enter", " "].includes(key) && byId("healthy-file").click());
    byId("healthy-remove").addEventListener("click", () => this.#setHealthy(null));
  }

  /** Another recording, or none: an answer about the one before means nothing any more. */
  setRecording(recording) {
    this.#recording = recording;
    byId("diagnosis").hidden = !recording;
    this.#forget();
  }

  /** Says where an answer is about another scenario than the page's. */
  changed() {
    byId("diagnosis-stale").hidden = this.#diagnosed === null || this.#diagnosed === rig(this.#question().scenario);
  }

  /** It says less or more than the recording that is diagnosed, so that it is asked for itself. */
  async #openHealthy(file) {
    try {
      const settings = await this.#desk.open(file);
      if (settings) this.#setHealthy({ file, settings });
    } catch (error) {
      this.#refused(error);
    }
  }

  #setHealthy(healthy) {
    this.#healthy = healthy;
    byId("healthy-name").textContent = healthy ? `Compared with ${healthy.file.name}, as healthy` : "Compared with no healthy recording";
    byId("healthy-remove").hidden = !healthy;
    this.#forget();
  }

  #forget() {
    this.#stop("");
    this.#diagnosed = null;
    this.changed();
    byId("seen").replaceChildren();
    byId("found").replaceChildren();
  }

  #stop(text) {
    this.#abort?.abort();
    this.#abort = null;
    this.#rest(text);
  }

  /** Nothing is under way. */
  #rest(text) {
    byId("diagnose").hidden = false;
    byId("stop").hidden = true;
    byId("progress").hidden = true;
    byId("diagnosis-status").textContent = text;
  }

  async #diagnose() {
    this.#forget();
    const abort = new AbortController();
    this.#abort = abort;
    byId("diagnose").hidden = true;
    byId("stop").hidden = false;
    byId("diagnosis-status").textContent = "reading…";
    const { file, settings } = this.#recording;
    const question = { ...this.#question(), records: Number(byId("records").value), recording: { ...settings, bytes: file.size } };
    const files = [file];
    if (this.#healthy) {
      question.healthy = { ...this.#healthy.settings, bytes: this.#healthy.file.size };
      files.push(this.#healthy.file);
    }
    this.#diagnosed = rig(question.scenario);
    try {
      for await (const said of diagnosis(question, files, abort.signal)) {
        if (this.#abort !== abort) return;
        this.#show(said);
      }
      if (this.#abort === abort) this.#stop("the program no longer answers: was it ended?");
    } catch (error) {
      if (this.#abort !== abort) return;
      if (!(error instanceof Refusal)) throw error;
      this.#refuse(error.details);
    }
  }

  #show({ seen, progress, answer, error }) {
    if (seen) this.#warn(seen);
    if (progress) this.#progress(progress);
    if (error) this.#refuse(error);
    if (answer) {
      this.#abort = null;
      this.#rest("");
      this.#warn(answer.warnings);
      byId("found").replaceChildren(...found(answer));
    }
  }

  #warn(messages) {
    byId("seen").append(...messages.map((textContent) => element("li", { textContent })));
  }

  #progress({ finished, of, counted }) {
    const bar = byId("progress");
    bar.hidden = false;
    // Without a value it says that something is under way.
    if (of) Object.assign(bar, { max: of, value: finished });
    else bar.removeAttribute("value");
    byId("diagnosis-status").textContent = of ? `${finished} of ${of} ${counted}` : counted;
  }

  #refuse({ text, help }) {
    this.#stop("");
    this.#diagnosed = null;
    byId("found").replaceChildren(paragraph([text, help].filter(Boolean).join("; "), "problem"));
  }
}

/** A scenario as text without its damage, which a diagnosis leaves out. */
const rig = ({ fault, ...rig }) => JSON.stringify(rig);

/** An answer; without probabilities where nothing can be said. */
function found({ summary, damaged, likeness, columns, kinds, others, notes }) {
  const parts = [paragraph(summary, "summary"), paragraph([damaged, likeness].filter(Boolean).join("; "))];
  if (kinds.length) {
    const head = element("thead");
    head.insertRow().append(...columns.map((textContent) => element("th", { textContent, scope: "col" })));
    const body = element("tbody");
    for (const [kind, ...cells] of kinds) {
      body.insertRow().append(element("th", { textContent: kind, scope: "row" }), ...cells.map((textContent) => element("td", { textContent })));
    }
    const table = element("table", { id: "kinds" });
    table.append(head, body);
    const around = element("div", { className: "scroll", tabIndex: 0, role: "region", ariaLabel: "Table of kinds" });
    around.append(table);
    parts.push(around);
  }
  return [...parts, ...[others, ...notes].filter(Boolean).map((text) => paragraph(text, "note"))];
}
