// What the pages of a pair and of a gearbox share: asking, refusals, files, recordings, and what is held or taken away.

import { Answers, Newest, Refusal, start, unpacked } from "./ask.js";
import { Diagnosis } from "./diagnosis.js";
import { Desk } from "./desk.js";
import { shown } from "./plots.js";
import { OpenedRecording } from "./recording.js";
import { held, linked, offer, ofAddress, said, saved } from "./taking.js";

const byId = (id) => document.getElementById(id);

/** For tests and measurements: how many pictures were drawn, and what the last one was; each is announced by the event `drawn`. */
window.meshtone = { drawn: 0, coarse: 0, last: null };

export class Page {
  #path;
  #controls;
  #view;
  #coarse;
  #answers;
  #diagnosis;
  #recording;

  /**
   * @param path whom is asked: of a pair, or of a gearbox
   * @param catalogue what the controls are made from, presets, and the scenario to begin with
   * @param controls what the scenario is set with
   * @param view what draws: `show`, `hold`, `setRecording`, `repaint`, `rest`; `asked` is what it looks at, `held` the answer that can be
   *   held, `keys` what a key does
   * @param coarse what is simulated while a control moves
   */
  constructor(path, catalogue, controls, view, coarse) {
    [this.#path, this.#controls, this.#view, this.#coarse] = [path, controls, view, coarse];
    const [question, refuse] = [() => this.#question("full"), (error) => this.refuse(error)];
    this.#answers = new Answers((answer, asked) => this.#show(answer, asked), refuse, path);
    const desk = new Desk(question, refuse, status);
    this.#diagnosis = new Diagnosis(desk, question, refuse, catalogue.records);
    const opened = (processed, recording, isSame = false) => {
      view.setRecording(processed);
      if (!isSame) this.#diagnosis.setRecording(recording);
    };
    this.#recording = new OpenedRecording(desk, question, opened, refuse, status);
    this.#listen(catalogue);
    this.open(ofAddress(refuse) ?? catalogue.scenario);
  }

  #question(detail) {
    return { scenario: this.#controls.scenario, detail, ...this.#view.asked };
  }

  /** Something was set. */
  change(detail) {
    this.#view.rest();
    status(detail === "coarse" ? "…" : "computing…");
    this.#answers.ask(this.#question(detail));
  }

  /** Something else is looked at in the recording too. */
  process() {
    this.#recording.process(true);
  }

  open(tree) {
    this.#controls.open(tree);
    this.change("full");
  }

  /** Says what is wrong: at its key, and in a line above all. */
  refuse(error) {
    const problem = byId("problem");
    problem.hidden = !error;
    byId("views").classList.toggle("stale", Boolean(error?.details?.key));
    if (!error) return;
    if (!(error instanceof Refusal)) throw error;
    this.#controls.refuse(error.details);
    problem.textContent = wrong(error.details);
    status("not computed");
  }

  #show(answer, asked) {
    this.#controls.show(answer);
    this.#view.show(answer);
    this.#diagnosis.changed();
    this.refuse(null);
    const isFull = answer.detail === "full";
    const drawn = performance.now();
    status(`${shown(drawn - asked, 3)} ms${isFull ? "" : `, ${this.#coarse}`}`);
    if (document.activeElement !== byId("toml")) byId("toml").value = answer.toml;
    window.meshtone.drawn += isFull ? 1 : 0;
    window.meshtone.coarse += isFull ? 0 : 1;
    window.meshtone.last = { asked, drawn, detail: answer.detail };
    document.dispatchEvent(new CustomEvent("drawn", { detail: answer.detail }));
  }

  /** Opens a scenario by its file's text. @returns the refusal, where there is one */
  async #openText(toml) {
    const asked = performance.now();
    try {
      const buffer = await new Newest(this.#path).ask({ toml, detail: "full", ...this.#view.asked });
      if (!buffer) return null;
      const answer = unpacked(buffer);
      this.#answers.forget();
      this.#controls.open(answer.brief ?? answer.scenario);
      this.#show(answer, asked);
      return null;
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      return error.details;
    }
  }

  /** A file: a scenario is opened, all else is a recording. */
  async #take(file) {
    if (!file) return;
    if (!file.name.endsWith(".toml")) {
      await this.#recording.open(file);
      return;
    }
    const refused = await this.#openText(await file.text());
    if (refused) this.refuse(new Refusal({ ...refused, text: `${file.name}: ${refused.text}`, key: null }));
  }

  #hold() {
    const { held: answer } = this.#view;
    this.#view.hold(held(byId("hold"), Boolean(answer)) ? answer : null);
  }

  #setTheme(theme) {
    document.documentElement.dataset.theme = theme;
    this.#view.repaint();
  }

  #listen({ presets }) {
    const refuse = (error) => this.refuse(error);
    offer(byId("preset"), presets, (tree) => {
      this.#view.forget?.();
      this.open(tree);
    });
    byId("hold").addEventListener("click", () => this.#hold());
    byId("link").addEventListener("click", () => said(status, refuse, linked(this.#view.held?.brief ?? this.#controls.scenario)));
    byId("theme").addEventListener("click", () => this.#setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
    document.querySelectorAll("[data-export]").forEach((button) => button.addEventListener("click", () => said(status, refuse, saved(button.dataset.export, this.#controls.scenario))));
    byId("file").addEventListener("change", ({ target }) => {
      this.#take(target.files[0]);
      target.value = "";
    });
    byId("file").parentElement.addEventListener("keydown", ({ key }) => ["Enter", " "].includes(key) && byId("file").click());
    byId("apply").addEventListener("click", async () => {
      const refused = await this.#openText(byId("toml").value);
      byId("toml-problem").textContent = refused ? wrong(refused) : "";
      if (refused?.line) selectLine(refused.line);
    });
    const keys = { h: () => this.#hold(), ...this.#view.keys };
    document.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("input, select, textarea, button, summary, label")) return;
      if (!keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
    });
    for (const [name, isOver] of [["dragover", true], ["dragleave", false], ["drop", false]]) {
      document.addEventListener(name, (event) => {
        event.preventDefault();
        document.body.classList.toggle("dropping", isOver);
        if (name === "drop") this.#take(event.dataTransfer.files[0]);
      });
    }
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", ({ matches }) => this.#setTheme(matches ? "dark" : "light"));
    addEventListener("hashchange", () => {
      const tree = ofAddress(refuse);
      if (tree) this.open(tree);
    });
  }
}

/** Makes a page of what the program says it is made from. @param make is given that */
export async function begin(make) {
  document.documentElement.dataset.theme = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
  try {
    make(await start());
  } catch (error) {
    byId("problem").hidden = false;
    byId("problem").textContent = error.message;
  }
}

function status(text) {
  byId("status").textContent = text;
}

const wrong = ({ text, help }) => [text, help].filter(Boolean).join("; ");

function selectLine(number) {
  const area = byId("toml");
  const lines = area.value.split("\n");
  const from = lines.slice(0, number - 1).join("\n").length + (number > 1 ? 1 : 0);
  area.focus();
  area.setSelectionRange(from, from + (lines[number - 1]?.length ?? 0));
}
