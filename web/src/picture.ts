import { BAR_WIDTH, drawBar, drawDecor, insetFor, type Bar } from "./decor";
import { h } from "./dom";
import type { Panel } from "./panel";
import { colour, FONT } from "./theme";

const HEAD = 34; // height of a title, CSS pixels

/**
 * All panels under their titles, arranged as on the screen, with axes and colour bar; as PNG in the pixels of the
 * screen.
 */
export function picture(panels: Panel[], bar: Bar | null, columns: number): Promise<Blob> {
  const ratio = window.devicePixelRatio || 1;
  const wide = Math.max(...panels.map((panel) => panel.frame.clientWidth));
  const tall = Math.max(...panels.map((panel) => panel.frame.clientHeight)) + HEAD;
  const width = columns * wide + (bar ? BAR_WIDTH : 0);
  const height = Math.ceil(panels.length / columns) * tall;
  const canvas = h("canvas", { width: Math.round(width * ratio), height: Math.round(height * ratio) });
  const ctx = canvas.getContext("2d")!;
  ctx.scale(ratio, ratio);
  ctx.fillStyle = colour("ground");
  ctx.fillRect(0, 0, width, height);
  panels.forEach((panel, n) => {
    const title = panels.length > 1 ? panel.result.label : panel.result.title;
    at(ctx, (n % columns) * wide, Math.floor(n / columns) * tall, () => drawPanel(ctx, panel, title));
  });
  if (bar) at(ctx, columns * wide, HEAD, () => drawBar(ctx, bar, height - HEAD));
  return new Promise((done, fail) => {
    canvas.toBlob((blob) => (blob ? done(blob) : fail(new Error("the picture could not be made"))), "image/png");
  });
}

function at(ctx: CanvasRenderingContext2D, x: number, y: number, draw: () => void): void {
  ctx.save();
  ctx.translate(x, y);
  draw();
  ctx.restore();
}

function drawPanel(ctx: CanvasRenderingContext2D, panel: Panel, title: string): void {
  const inset = insetFor(panel.dimension);
  // The browser clears a canvas of WebGL once it has shown it: draw anew, and copy in the same turn.
  panel.scene.render();
  ctx.drawImage(panel.scene.canvas, inset.left, HEAD + inset.top, ...panel.size);
  at(ctx, 0, HEAD, () => drawDecor(ctx, panel.decor()));
  ctx.fillStyle = colour("ink");
  ctx.textAlign = "left";
  ctx.textBaseline = "middle";
  ctx.font = `600 15px ${FONT}`;
  ctx.fillText(`${title} – ${panel.caption}`, 10, 18, panel.frame.clientWidth - 20);
}
