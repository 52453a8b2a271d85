// Colours of the style sheet, for drawings on canvases.

export type Colour =
  | "panel" | "edge" | "text" | "dim" | "accent" | "good" | "fair" | "bad" | "truth" | "corridor" | "grid" | "sea" | "land"
  | "night";

const cache = new Map<Colour, string>();
const light = matchMedia("(prefers-color-scheme: light)");

export function colour(name: Colour): string {
  let value = cache.get(name);
  if (value === undefined) {
    value = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
    cache.set(name, value);
  }
  return value;
}

/** Calls back when the colours have changed. */
export function onThemeChange(callback: () => void): void {
  light.addEventListener("change", () => {
    cache.clear();
    callback();
  });
}
