// PNG files read by hand: what a screenshot shows, pixel by pixel.

import { inflateSync } from "node:zlib";

/** { width, height, at(x, y) -> [r, g, b] } of a PNG of 8 bits per channel, without interlace. */
export function decode(png) {
  let [width, height, channels] = [0, 0, 0];
  const parts = [];
  for (let at = 8; at < png.length; ) {
    const length = png.readUInt32BE(at);
    const kind = png.toString("latin1", at + 4, at + 8);
    const body = png.subarray(at + 8, at + 8 + length);
    if (kind === "IHDR") {
      [width, height] = [body.readUInt32BE(0), body.readUInt32BE(4)];
      channels = { 2: 3, 6: 4 }[body[9]];
      if (body[8] !== 8 || !channels || body[12] !== 0) throw new Error("a kind of PNG that is not read here");
    }
    if (kind === "IDAT") parts.push(body);
    at += 12 + length;
  }
  const pixels = unfilter(inflateSync(Buffer.concat(parts)), width, height, channels);
  const at = (x, y) => {
    const i = (Math.round(y) * width + Math.round(x)) * channels;
    return [pixels[i], pixels[i + 1], pixels[i + 2]];
  };
  return { width, height, at };
}

function unfilter(raw, width, height, channels) {
  const row = width * channels;
  const out = new Uint8Array(row * height);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (row + 1)];
    for (let i = 0; i < row; ++i) {
      const left = i >= channels ? out[y * row + i - channels] : 0;
      const up = y > 0 ? out[(y - 1) * row + i] : 0;
      const corner = i >= channels && y > 0 ? out[(y - 1) * row + i - channels] : 0;
      const guess = [0, left, up, (left + up) >> 1, paeth(left, up, corner)][filter];
      out[y * row + i] = raw[y * (row + 1) + 1 + i] + guess;
    }
  }
  return out;
}

function paeth(a, b, c) {
  const p = a + b - c;
  const [pa, pb, pc] = [Math.abs(p - a), Math.abs(p - b), Math.abs(p - c)];
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

/** How many different colours there are in a part of a picture. */
export function colours(picture, { x, y, width, height }) {
  const found = new Set();
  for (let j = Math.ceil(y); j < y + height - 1; ++j)
    for (let i = Math.ceil(x); i < x + width - 1; ++i) found.add(picture.at(i, j).join());
  return found;
}

/** The part of the pixels in which two pictures differ. */
export function difference(a, b, { x, y, width, height }) {
  let different = 0;
  let all = 0;
  for (let j = Math.ceil(y); j < y + height - 1; ++j)
    for (let i = Math.ceil(x); i < x + width - 1; ++i, ++all) if (a.at(i, j).join() !== b.at(i, j).join()) ++different;
  return different / all;
}

export const near = (a, b, tolerance) => a.every((c, n) => Math.abs(c - b[n]) <= tolerance);
