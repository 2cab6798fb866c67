// The page of a pair: what it is compared with is asked for after it is drawn.

import { Newest, unpacked } from "./ask.js";
import { Controls } from "./controls.js";
import { Page, begin } from "./page.js";
import { Views } from "./views.js";

const byId = (id) => document.getElementById(id);
/** How long nothing changes before what takes longer is asked for, in ms. */
const PAUSE = 150;

class PairView {
  #views = new Views(() => this.#views.now && this.#compare(this.#views.now));
  #refuse;
  #pause = 0;
  #healthy = new Newest("healthy");
  #severity = new Newest("severity");
  asked = { channel: null };
  keys = { " ": () => this.#views.togglePlay() };

  /** @param refuse is told where what it is compared with cannot be had */
  constructor(refuse) {
    this.#refuse = refuse;
  }

  get held() {
    return this.#views.now;
  }

  rest() {
    clearTimeout(this.#pause);
    this.#healthy.stop();
    this.#severity.stop();
    this.#views.rest();
  }

  show(answer) {
    this.#views.show(answer);
    clearTimeout(this.#pause);
    if (answer.detail === "full") this.#pause = setTimeout(() => this.#compare(answer), PAUSE);
  }

  hold(answer) {
    this.#views.hold(answer);
  }

  setRecording(processed) {
    this.#views.setRecording(processed);
  }

  repaint() {
    this.#views.repaint();
  }

  /** What the full answer is compared with. */
  async #compare(answer) {
    const faults = [answer.scenario.fault ?? []].flat();
    const asked = { scenario: answer.brief, ...this.asked };
    try {
      if (!answer.healthy) {
        const buffer = await this.#healthy.ask({ ...asked, detail: "full" });
        if (buffer) this.#views.setHealthy(JSON.parse(new TextDecoder().decode(buffer)).healthy);
      }
      if (faults.length) {
        const fault = Math.min(this.#views.fault, faults.length - 1);
        const buffer = await this.#severity.ask({ ...asked, fault });
        if (buffer) this.#views.setSeverity(unpacked(buffer));
      }
    } catch (error) {
      this.#refuse(error);
    }
  }
}

begin((catalogue) => {
  const view = new PairView((error) => page.refuse(error));
  const controls = new Controls(byId("controls"), catalogue, (detail) => page.change(detail));
  const page = new Page("answer", catalogue, controls, view, "three revolutions");
  byId("channel").addEventListener("change", ({ target }) => {
    view.asked.channel = target.value;
    page.change("full");
  });
});
