// What is taken away from a page of any scenario: files, and an address that restores what is set.

import { Refusal, exported } from "./ask.js";

const encoded = (tree) => btoa(String.fromCharCode(...new TextEncoder().encode(JSON.stringify(tree)))).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");

/** The scenario that the address names; null where it names none. @param refuse is told where it cannot be read */
export function ofAddress(refuse) {
  if (location.hash.length < 2) return null;
  try {
    const bytes = Uint8Array.from(atob(location.hash.slice(1).replaceAll("-", "+").replaceAll("_", "/")), (letter) => letter.charCodeAt(0));
    return JSON.parse(new TextDecoder().decode(bytes));
  } catch {
    refuse(new Refusal({ kind: "unfit", text: "what follows # in the address is no scenario of this page: was it cut off?" }));
    return null;
  }
}

/** Puts a scenario into the address and copies that. @returns what is said about it */
export async function linked(tree) {
  history.replaceState(null, "", `#${encoded(tree)}`);
  try {
    await navigator.clipboard.writeText(location.href);
    return "link copied";
  } catch {
    return "the link is in the address line";
  }
}

/** Does something whose outcome is said. @param refuse is told where it is refused */
export async function said(say, refuse, outcome) {
  try {
    say(await outcome);
  } catch (error) {
    refuse(error);
  }
}

/** Saves a file of a scenario. @returns what is said about it */
export async function saved(form, scenario) {
  const { blob, name } = await exported(form, scenario);
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  return `${name} saved`;
}

/** Scenarios to begin with. @param open is given the chosen one */
export function offer(select, presets, open) {
  select.append(new Option("begin with…", ""), ...presets.map(({ name, title }) => new Option(title, name)));
  select.addEventListener("change", () => {
    const preset = presets.find(({ name }) => name === select.value);
    if (preset) open(preset.scenario);
  });
}

/** Holds what is shown, or lets it go. @returns whether it is held now */
export function held(button, isThere) {
  const isHeld = button.getAttribute("aria-pressed") !== "true" && isThere;
  button.setAttribute("aria-pressed", String(isHeld));
  button.textContent = isHeld ? "Held" : "Hold";
  return isHeld;
}
