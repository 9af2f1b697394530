/// Color classes in the order of their labels 0 .. 8; no_color says: none of the others.
export const color_classes = ["no_color", "black", "white", "green", "blue", "cyan", "magenta", "red", "yellow"] as const;
export type ColorClass = (typeof color_classes)[number];

export function label_of(color: ColorClass): number {
  return color_classes.indexOf(color);
}

/// As people read it.
export function title_of(color: ColorClass): string {
  return color.replace("_", " ");
}

export type Rgb = readonly [number, number, number];

/// How labels are drawn, by label. They must be told apart from each other and from what they lie on, so they are stronger than the things themselves.
export const label_colors: readonly Rgb[] = [
  [92, 98, 104], [10, 10, 12], [255, 255, 255], [0, 176, 70], [36, 92, 255], [0, 214, 230], [236, 40, 214], [255, 74, 20], [255, 216, 0],
];

/// The same for lines on a dark ground, where black would not be seen.
export function line_color(label: number): Rgb {
  return label === 1 ? [150, 158, 166] : label_colors[label]!;
}

export function css_color([r, g, b]: Rgb, alpha = 1): string {
  return `rgb(${r} ${g} ${b} / ${alpha})`;
}
