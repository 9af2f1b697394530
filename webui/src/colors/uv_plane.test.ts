import { expect, test } from "vitest";
import { numbers_from, random_table } from "../testing";
import type { ColorTable } from "./classify";
import { label_of } from "./color_class";
import { cell_at, classes_of_cell, outline_of, paint_plane, used_window } from "./uv_plane";

test("a cell's classes are those whose bits it has", () => {
  const table = random_table(1);
  for (let n = 0; n < 256; ++n) {
    const bits = classes_of_cell(table, n, 255 - n).reduce((sum, color) => sum | (1 << (label_of(color) - 1)), 0);
    expect(bits).toBe(table.chroma[(255 - n) * 256 + n]);
  }
});

test("an outline is as long as there are edges between cells that differ, whatever the cells", () => {
  for (let seed = 0; seed < 5; ++seed) {
    const random = numbers_from(seed, 0, 1);
    const chroma = Uint8Array.from({ length: 65536 }, () => (random() < 0.3 ? 8 : 0));
    const table: ColorTable = { ...random_table(seed), chroma };
    const has = (u: number, v: number): number => (u < 0 || u > 255 || v < 0 || v > 255 ? 0 : chroma[v * 256 + u]!);
    let edges = 0;
    for (let v = 0; v <= 256; ++v) for (let u = 0; u <= 256; ++u) edges += Number(has(u, v) !== has(u - 1, v)) + Number(has(u, v) !== has(u, v - 1));
    const lines = outline_of(table, "blue");
    let length = 0;
    for (let i = 0; i < lines.length; i += 4) length += Math.abs(lines[i + 2]! - lines[i]!) + Math.abs(lines[i + 3]! - lines[i + 1]!);
    expect(length).toBe(edges);
  }
});

test("one cell has four edges around it, V up", () => {
  const chroma = new Uint8Array(65536);
  chroma[200 * 256 + 10] = 4;
  const lines = outline_of({ ...random_table(0), chroma }, "green");
  expect(lines.length).toBe(16);
  expect([Math.min(...lines.filter((_, i) => i % 2 === 0)), Math.max(...lines.filter((_, i) => i % 2 === 0))]).toEqual([10, 11]);
  expect([Math.min(...lines.filter((_, i) => i % 2 === 1)), Math.max(...lines.filter((_, i) => i % 2 === 1))]).toEqual([55, 56]);
});

test("the window holds all that is used, and the point of a cell is found again", () => {
  const random = numbers_from(7, 0, 256);
  for (let n = 0; n < 50; ++n) {
    const chroma = new Uint8Array(65536);
    const cells = Array.from({ length: 1 + (n % 4) }, () => ({ u: Math.floor(random()), v: Math.floor(random()) }));
    for (const { u, v } of cells) chroma[v * 256 + u] = 1;
    const window = used_window({ table: { ...random_table(0), chroma }, density: null, color: "black" });
    expect(window.u >= 0 && window.v >= 0 && window.u + window.side <= 256 && window.v + window.side <= 256).toBe(true);
    for (const { u, v } of cells) {
      const [x, y] = [(300 * (u + 0.5 - window.u)) / window.side, 300 * (1 - (v + 0.5 - window.v) / window.side)];
      expect(x >= 0 && x < 300 && y >= 0 && y < 300).toBe(true);
      expect(cell_at(x, y, 300, window)).toEqual({ u, v });
    }
  }
});

test("cells that were seen are brighter than those that were not, and more often is brighter", () => {
  const density = new Uint8Array(65536);
  const [at, often, seldom] = [128 * 256 + 128, 128 * 256 + 129, 128 * 256 + 130];
  density[often] = 255;
  density[seldom] = 1;
  const out = new Uint32Array(65536);
  paint_plane(density, "limited", out);
  const brightness = (cell: number): number => out[(255 - (cell >> 8)) * 256 + (cell & 255)]! & 255;
  expect(brightness(often)).toBeGreaterThan(brightness(seldom));
  expect(brightness(seldom)).toBeGreaterThan(brightness(at));
});
