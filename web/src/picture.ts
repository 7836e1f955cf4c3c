import { drawDecor, insetFor, type Bar } from "./decor";
import { h } from "./dom";
import type { Panel } from "./panel";
import { colour, FONT } from "./theme";

const HEAD = 34; // height of the title, CSS pixels

/** All panels side by side under their titles, with axes and colour bars, as PNG in the pixels of the screen. */
export function picture(panels: Panel[], bar: Bar | null): Promise<Blob> {
  const ratio = window.devicePixelRatio || 1;
  const width = panels.reduce((sum, panel) => sum + panel.frame.clientWidth, 0);
  const height = Math.max(...panels.map((panel) => panel.frame.clientHeight)) + HEAD;
  const canvas = h("canvas", { width: Math.round(width * ratio), height: Math.round(height * ratio) });
  const ctx = canvas.getContext("2d")!;
  ctx.scale(ratio, ratio);
  ctx.fillStyle = colour("ground");
  ctx.fillRect(0, 0, width, height);
  for (const panel of panels) {
    drawPanel(ctx, panel, bar, panels.length > 1 ? panel.result.name : panel.result.title);
    ctx.translate(panel.frame.clientWidth, 0);
  }
  return new Promise((done, fail) => {
    canvas.toBlob((blob) => (blob ? done(blob) : fail(new Error("the picture could not be made"))), "image/png");
  });
}

function drawPanel(ctx: CanvasRenderingContext2D, panel: Panel, bar: Bar | null, title: string): void {
  const inset = insetFor(panel.dimension);
  // The browser clears a canvas of WebGL once it has shown it: draw anew, and copy in the same turn.
  panel.scene.render();
  ctx.drawImage(panel.scene.canvas, inset.left, HEAD + inset.top, ...panel.size);
  ctx.save();
  ctx.translate(0, HEAD);
  drawDecor(ctx, panel.decor(bar));
  ctx.restore();
  ctx.fillStyle = colour("ink");
  ctx.textAlign = "left";
  ctx.textBaseline = "middle";
  ctx.font = `600 15px ${FONT}`;
  ctx.fillText(`${title} – ${panel.caption}`, 10, 18, panel.frame.clientWidth - 20);
}
