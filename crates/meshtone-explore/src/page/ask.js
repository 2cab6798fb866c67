// What the page asks the program, in order: while a control moves one coarse answer is on its way and the newest wish waits; a full
// answer takes the place of all before it.

const page = Array.from(crypto.getRandomValues(new Uint32Array(2)), (number) => number.toString(36)).join("");
let numbered = 0;

/** A refusal by the program, in its own words. */
export class Refusal extends Error {
  constructor(details) {
    super(details.text ?? "the program refused, without saying why");
    this.details = details;
  }
}

async function refusalOf(response) {
  const text = await response.text();
  try {
    return new Refusal(JSON.parse(text).error);
  } catch {
    const tooLarge = response.status === 413 ? "this is larger than the page takes (a recording: 64 MiB)" : text;
    return new Refusal({ kind: "unfit", text: tooLarge || `the program answered ${response.status}` });
  }
}

async function post(path, body, signal) {
  const response = await fetch(path, { method: "POST", body, signal });
  if (!response.ok) throw await refusalOf(response);
  return response;
}

/** An answer's JSON, in which what stands for an array has become one. */
export function unpacked(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const text = new TextDecoder().decode(new Uint8Array(buffer, 4, length));
  const withArrays = (value) => {
    if (value === null || typeof value !== "object") return value;
    if (value.array_at !== undefined) return new Float32Array(buffer, 4 + length + 4 * value.array_at, value.length);
    for (const key of Object.keys(value)) value[key] = withArrays(value[key]);
    return value;
  };
  return withArrays(JSON.parse(text));
}

export async function start() {
  const response = await fetch("start");
  if (!response.ok) throw await refusalOf(response);
  return response.json();
}

/** Asks for one thing, of which only the newest answer counts. */
export class Newest {
  #path;
  #abort = null;

  constructor(path) {
    this.#path = path;
  }

  stop() {
    this.#abort?.abort();
    this.#abort = null;
  }

  /** The response; null where a later question has taken its place. */
  async ask(question, file = null) {
    this.stop();
    const abort = new AbortController();
    this.#abort = abort;
    const text = JSON.stringify({ ...question, page, number: ++numbered });
    try {
      const response = await post(this.#path, file ? framed(text, [file]) : text, abort.signal);
      const buffer = await response.arrayBuffer();
      return this.#abort === abort ? buffer : null;
    } catch (error) {
      if (abort.signal.aborted || error.details?.kind === "superseded") return null;
      throw error instanceof Refusal ? error : gone();
    }
  }
}

/** What is said of a diagnosis, one thing after another: it goes on until it is at its end, or the signal aborts it. */
export async function* diagnosis(question, files, signal) {
  const text = JSON.stringify({ ...question, page, number: ++numbered });
  try {
    const response = await post("diagnosis", framed(text, files), signal);
    const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
    let rest = "";
    for (let part = await reader.read(); !part.done; part = await reader.read()) {
      const lines = (rest + part.value).split("\n");
      rest = lines.pop();
      for (const line of lines) yield JSON.parse(line);
    }
  } catch (error) {
    if (error instanceof Refusal || signal.aborted) throw error;
    throw gone();
  }
}

const gone = () => new Refusal({ kind: "gone", text: "the program no longer answers: was it ended?" });

/** A text and files behind it, as the program reads them. */
function framed(text, files) {
  const bytes = new TextEncoder().encode(text);
  const length = new Uint8Array(4);
  new DataView(length.buffer).setUint32(0, bytes.length, true);
  return new Blob([length, bytes, ...files]);
}

/** Answers about the scenario, in order. */
export class Answers {
  #newest;
  #busy = null;
  #waiting = null;
  #show;
  #refuse;

  /** @param path whom is asked: of a pair, or of a gearbox */
  constructor(show, refuse, path = "answer") {
    this.#newest = new Newest(path);
    this.#show = show;
    this.#refuse = refuse;
  }

  /**
   * Asks; a coarse question waits for the one before it, and a moment at least: a press of a key moves and releases a control at once.
   * Only the last of those that wait is asked.
   */
  ask(question) {
    if (question.detail === "coarse") {
      if (this.#busy === "full") return;
      this.#waiting = question;
      setTimeout(() => this.#next());
      return;
    }
    this.#waiting = null;
    this.#send(question);
  }

  /** What is on its way or waits is no longer wanted. */
  forget() {
    this.#newest.stop();
    this.turn = {};
    this.#busy = null;
    this.#waiting = null;
  }

  #next() {
    const next = this.#waiting;
    if (!next || this.#busy) return;
    this.#waiting = null;
    this.#send(next);
  }

  async #send(question) {
    this.#busy = question.detail;
    const asked = performance.now();
    const mine = (this.turn = {});
    try {
      const buffer = await this.#newest.ask(question);
      if (buffer && mine === this.turn) this.#show(unpacked(buffer), asked);
    } catch (error) {
      if (mine === this.turn) this.#refuse(error);
    }
    if (mine !== this.turn) return;
    this.#busy = null;
    this.#next();
  }
}

/** A file of the scenario: its bytes and its name. */
export async function exported(form, scenario) {
  const response = await post(`export/${form}`, JSON.stringify({ scenario, page: `${page}-${form}`, number: ++numbered }));
  const name = /filename="([^"]+)"/.exec(response.headers.get("Content-Disposition") ?? "")?.[1];
  return { blob: await response.blob(), name: name ?? `scenario.${form}` };
}
