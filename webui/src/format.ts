// Numbers as the pages show them. A missing number is a dash, never a zero; a unit never stands alone on a line.

export const missing = "–";

export function fixed(value: number | null | undefined, digits: number): string {
  if (value == null || !Number.isFinite(value)) return missing;
  const text = value.toFixed(digits);
  return /^-0\.?0*$/.test(text) ? text.slice(1) : text.replace("-", "−");
}

/// Of an angle in radians, counter-clockwise positive, [deg].
export function degrees(angle: number | null | undefined, digits = 1): string {
  return angle == null ? missing : `${fixed((angle * 180) / Math.PI, digits)}°`;
}

/// Which way and how far: "12.3° left". Straight ahead has no side.
export function bearing(angle: number | null | undefined): string {
  if (angle == null) return missing;
  const text = fixed(Math.abs((angle * 180) / Math.PI), 1);
  return text === "0.0" ? "0.0°" : `${text}°\u00a0${angle > 0 ? "left" : "right"}`;
}

export function meters(value: number | null | undefined, digits = 2): string {
  return value == null ? missing : `${fixed(value, digits)}\u00a0m`;
}

/// In the largest unit that keeps it readable.
export function plus_minus(sigma: number | null | undefined): string {
  if (sigma == null || !Number.isFinite(sigma)) return "";
  return sigma < 0.0995 ? `±\u00a0${fixed(sigma * 100, 1)}\u00a0cm` : `±\u00a0${fixed(sigma, 2)}\u00a0m`;
}

/// "1" is no unit, and powers are raised.
export function unit(text: string): string {
  return text === "1" ? "" : text.replace(/\^2/g, "²").replace(/\^3/g, "³").replace(/sqrt\((\w+)\)/g, "√$1");
}

export function count(value: number): string {
  return String(value).replace(/\B(?=(\d{3})+(?!\d))/g, "\u202f");
}
