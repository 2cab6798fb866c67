// The page: controls ask, the program answers, views show.

import { Answers, Newest, Refusal, start, unpacked } from "./ask.js";
import { Controls } from "./controls.js";
import { Diagnosis } from "./diagnosis.js";
import { shown } from "./plots.js";
import { held, linked, offer, ofAddress, said, saved } from "./taking.js";
import { Views } from "./views.js";

const byId = (id) => document.getElementById(id);
/** How long nothing changes before what takes longer is asked for, in ms. */
const PAUSE = 150;

let controls;
let views;
let answers;
let diagnosis;
let channel = null;
let recording = null;
let pause = 0;
const healthy = new Newest("healthy");
const severity = new Newest("severity");
const recordings = new Newest("recording");

/** For tests and measurements: how many pictures were drawn, and what the last one was; each is announced by the event `drawn`. */
window.meshtone = { drawn: 0, coarse: 0, last: null };

const question = (detail) => ({ scenario: controls.scenario, detail, channel });

function change(detail) {
  clearTimeout(pause);
  healthy.stop();
  severity.stop();
  status(detail === "coarse" ? "…" : "computing…");
  answers.ask(question(detail));
  views.rest();
}

function status(text) {
  byId("status").textContent = text;
}

function show(answer, asked) {
  controls.show(answer);
  views.show(answer);
  diagnosis.changed();
  showProblem(null);
  const now = performance.now();
  const isFull = answer.detail === "full";
  status(isFull ? `${shown(now - asked, 3)} ms` : `${shown(now - asked, 3)} ms, three revolutions`);
  if (document.activeElement !== byId("toml")) byId("toml").value = answer.toml;
  window.meshtone.drawn += isFull ? 1 : 0;
  window.meshtone.coarse += isFull ? 0 : 1;
  window.meshtone.last = { asked, drawn: now, detail: answer.detail };
  document.dispatchEvent(new CustomEvent("drawn", { detail: answer.detail }));
  clearTimeout(pause);
  if (isFull) pause = setTimeout(compare, PAUSE, answer);
}

/** What the full answer is compared with. */
async function compare(answer) {
  const faults = [answer.scenario.fault ?? []].flat();
  const asked = { scenario: answer.brief, channel };
  try {
    if (!answer.healthy) {
      const buffer = await healthy.ask({ ...asked, detail: "full" });
      if (buffer) views.setHealthy(JSON.parse(new TextDecoder().decode(buffer)).healthy);
    }
    if (faults.length) {
      const fault = Math.min(views.fault, faults.length - 1);
      const buffer = await severity.ask({ ...asked, fault });
      if (buffer) views.setSeverity(unpacked(buffer));
    }
  } catch (error) {
    showProblem(error);
  }
}

/** Says what is wrong: at its key, and in a line above all. */
function showProblem(error) {
  const problem = byId("problem");
  problem.hidden = !error;
  byId("views").classList.toggle("stale", Boolean(error?.details?.key));
  if (!error) return;
  if (!(error instanceof Refusal)) throw error;
  const { details } = error;
  controls.refuse(details);
  problem.textContent = [details.text, details.help].filter(Boolean).join("; ");
  status("not computed");
}

/** Opens a scenario by its file's text. @returns the refusal, where there is one */
async function openText(toml) {
  const asking = new Newest("answer");
  const asked = performance.now();
  try {
    const buffer = await asking.ask({ toml, detail: "full", channel });
    if (!buffer) return null;
    const answer = unpacked(buffer);
    answers.forget();
    controls.open(answer.brief);
    show(answer, asked);
    return null;
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    return error.details;
  }
}

function open(tree) {
  controls.open(tree);
  change("full");
}

/** A file: a scenario is opened, all else is a recording. */
async function take(file) {
  if (!file) return;
  if (file.name.endsWith(".toml")) {
    const refused = await openText(await file.text());
    if (refused) showProblem(new Refusal({ ...refused, text: `${file.name}: ${refused.text}`, key: null }));
    return;
  }
  recording = { file, settings: { name: file.name } };
  await process();
}

async function process() {
  if (!recording) return;
  status("reading…");
  try {
    const buffer = await recordings.ask({ ...question("full"), channel: recording.settings.channel, ...recording.settings }, recording.file);
    if (!buffer) return;
    const processed = unpacked(buffer);
    views.setRecording(processed);
    diagnosis.setRecording(recording);
    showRecording(processed);
    showProblem(null);
    status(`${processed.name}: ${processed.warnings.length ? "read, with warnings" : "read"}`);
  } catch (error) {
    // What was there before stays; this file was none.
    if (!byId("recording").childElementCount) recording = null;
    showProblem(error);
  }
}

/** What can be said about a recording. */
function showRecording(processed) {
  const box = byId("recording");
  const choice = (label, names, chosen, set) => {
    const select = document.createElement("select");
    select.append(...names.map((name) => new Option(name, name, false, name === chosen)));
    select.addEventListener("change", () => set(select.value));
    const around = document.createElement("label");
    around.append(`${label} `, select);
    return around;
  };
  const constant = "constant speed";
  const set = (key) => (value) => {
    recording.settings[key] = value === constant ? undefined : value;
    process();
  };
  const remove = Object.assign(document.createElement("button"), { textContent: "Remove recording" });
  remove.addEventListener("click", () => {
    recording = null;
    box.replaceChildren();
    box.hidden = true;
    views.setRecording(null);
    diagnosis.setRecording(null);
  });
  const name = Object.assign(document.createElement("span"), { textContent: `Recording ${processed.name}, by ${processed.turning}` });
  const warned = document.createElement("ul");
  warned.className = "warned";
  warned.append(...processed.warnings.map((text) => Object.assign(document.createElement("li"), { textContent: text })));
  box.replaceChildren(name, choice("channel", processed.channels, processed.signal.channel.name, set("channel")),
    choice("tachometer", [constant, ...processed.channels], recording.settings.tachometer ?? constant, set("tachometer")), remove, warned);
  box.hidden = false;
}

function hold() {
  views.hold(held(byId("hold"), Boolean(views.now)) ? views.now : null);
}

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  views?.repaint();
}

function listen(catalogue) {
  offer(byId("preset"), catalogue.presets, open);
  byId("hold").addEventListener("click", hold);
  byId("link").addEventListener("click", () => said(status, showProblem, linked(views.now?.brief ?? controls.scenario)));
  byId("theme").addEventListener("click", () => setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
  document.querySelectorAll("[data-export]").forEach((button) => button.addEventListener("click", () => said(status, showProblem, saved(button.dataset.export, controls.scenario))));
  byId("file").addEventListener("change", ({ target }) => {
    take(target.files[0]);
    target.value = "";
  });
  byId("file").parentElement.addEventListener("keydown", ({ key }) => ["Enter", " "].includes(key) && byId("file").click());
  byId("channel").addEventListener("change", ({ target }) => {
    channel = target.value;
    change("full");
  });
  byId("apply").addEventListener("click", async () => {
    const refused = await openText(byId("toml").value);
    byId("toml-problem").textContent = refused ? [refused.text, refused.help].filter(Boolean).join("; ") : "";
    if (refused?.line) selectLine(refused.line);
  });
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("input, select, textarea, button, summary, label")) return;
    if (event.key === "h") hold();
    if (event.key === " ") {
      event.preventDefault();
      views.togglePlay();
    }
  });
  for (const [name, isOver] of [["dragover", true], ["dragleave", false], ["drop", false]]) {
    document.addEventListener(name, (event) => {
      event.preventDefault();
      document.body.classList.toggle("dropping", isOver);
      if (name === "drop") take(event.dataTransfer.files[0]);
    });
  }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", ({ matches }) => setTheme(matches ? "dark" : "light"));
  addEventListener("hashchange", () => {
    const tree = ofAddress(showProblem);
    if (tree) open(tree);
  });
}

function selectLine(number) {
  const area = byId("toml");
  const lines = area.value.split("\n");
  const from = lines.slice(0, number - 1).join("\n").length + (number > 1 ? 1 : 0);
  area.focus();
  area.setSelectionRange(from, from + (lines[number - 1]?.length ?? 0));
}

setTheme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
try {
  const catalogue = await start();
  controls = new Controls(byId("controls"), catalogue, change);
  views = new Views(() => views.now && compare(views.now));
  answers = new Answers(show, showProblem);
  diagnosis = new Diagnosis(() => question("full"), catalogue.records);
  listen(catalogue);
  open(ofAddress(showProblem) ?? catalogue.scenario);
} catch (error) {
  byId("problem").hidden = false;
  byId("problem").textContent = error.message;
}
