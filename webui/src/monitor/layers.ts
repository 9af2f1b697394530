/// What the field window shows, in the order of its switches. To add a layer: name it here, draw it in field_drawing.ts.
export const all_layers = [
  { key: "free_space", title: "free space", usual: true },
  { key: "trails", title: "trails", usual: true },
  { key: "uncertainty", title: "uncertainty", usual: true },
  { key: "balls", title: "balls", usual: true },
  { key: "opponents", title: "robots seen", usual: true },
  { key: "team", title: "team ball and opponents", usual: true },
  { key: "tracks", title: "tracks", usual: true },
  { key: "lines", title: "lines", usual: false },
  { key: "goals", title: "goals", usual: false },
] as const;

export type LayerKey = (typeof all_layers)[number]["key"];
export type Layers = Readonly<Record<LayerKey, boolean>>;

export const usual_layers = Object.fromEntries(all_layers.map(({ key, usual }) => [key, usual])) as Layers;

/// From what was remembered: layers that it does not know are as usual, and so is what is no memory of ours.
export function layers_from(text: string | null): Layers {
  try {
    const known = JSON.parse(text ?? "{}") as Record<string, unknown>;
    return Object.fromEntries(all_layers.map(({ key, usual }) => [key, typeof known?.[key] === "boolean" ? known[key] : usual])) as Layers;
  } catch {
    return usual_layers;
  }
}
