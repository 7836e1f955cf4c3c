// Light and dark: colours live in the style sheet, and what is drawn on canvases asks for them here.

export type Theme = "light" | "dark";

const system = window.matchMedia("(prefers-color-scheme: dark)");
const listeners: (() => void)[] = [];
let chosen: Theme | null = null;

export const theme = (): Theme => chosen ?? (system.matches ? "dark" : "light");

export function setTheme(next: Theme): void {
  chosen = next;
  apply();
}

/** Calls `listener` whenever the theme changes. */
export const onTheme = (listener: () => void): void => void listeners.push(listener);

function apply(): void {
  document.documentElement.dataset.theme = theme();
  listeners.forEach((listener) => listener());
}
system.addEventListener("change", apply);
document.documentElement.dataset.theme = theme();

/** A colour of the style sheet: colour("ground"). */
export const colour = (name: string): string =>
  getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/** The same as numbers in 0..1; the style sheet writes them as #rrggbb. */
export function rgb(name: string): [number, number, number] {
  const hex = parseInt(colour(name).slice(1), 16);
  return [(hex >> 16) / 255, ((hex >> 8) & 255) / 255, (hex & 255) / 255];
}

export const FONT = '"Inter", "Segoe UI", system-ui, "Helvetica Neue", "DejaVu Sans", sans-serif';
