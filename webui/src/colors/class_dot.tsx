import { type ColorClass, css_color, label_colors, label_of } from "./color_class";

/// The color that a class has in pictures.
export function ClassDot({ color }: { color: ColorClass }) {
  return <span class="dot-of" style={{ background: css_color(label_colors[label_of(color)]!) }} aria-hidden="true" />;
}
