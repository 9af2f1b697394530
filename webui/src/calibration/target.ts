/// A calibration target as it is typed, field by field. Its text form is that of `tassilo calibrate`: dots:COLUMNSxROWS:PITCH:RADIUS, checker:COLUMNSxROWS:PITCH or
/// aprilgrid:TAGCOLSxTAGROWS:TAGSIZE:TAGSPACING.
export interface TargetFields {
  readonly kind: "dots" | "checker" | "aprilgrid";
  /// Of dots, inner corners or tags.
  readonly columns: string;
  readonly rows: string;
  /// Between neighbors; of tags, their size. [m]
  readonly pitch: string;
  /// Of a dot; means nothing for others. [m]
  readonly radius: string;
  /// The gap between tags as a share of their size; means nothing for others.
  readonly spacing: string;
}

export const first_target: TargetFields = { kind: "dots", columns: "7", rows: "7", pitch: "0.025", radius: "0.00625", spacing: "0.3" };

export const least_count = 3, most_count = 64;
/// A tag has two corners across, and the family so many tags.
const least_tags = 2, most_tags = 32, all_tags = 587;
const least_spacing = 0.1, most_spacing = 1;
/// Longer ones are millimeters that were meant as meters. [m]
export const longest_pitch = 1;

/// Some people write 0,04.
function number_of(typed: string): number | null {
  const clean = typed.trim().replace(",", ".");
  return /^\d*\.?\d+(e-?\d+)?$/i.test(clean) ? Number(clean) : null;
}

function whole_of(typed: string): number | null {
  return /^\d+$/.test(typed.trim()) ? Number(typed) : null;
}

/// Why they are no target, naming the first field that is wrong; empty when they are one.
export function why_no_target({ kind, columns, rows, pitch, radius, spacing }: TargetFields): string {
  const [least, most] = kind === "aprilgrid" ? [least_tags, most_tags] : [least_count, most_count];
  for (const [name, typed] of [["columns", columns], ["rows", rows]] as const) {
    const value = whole_of(typed);
    if (value === null) return `${name}: is '${typed}', must be a whole number`;
    if (value < least || value > most) return `${name}: is ${value}, must be ${least} to ${most}`;
  }
  const distance = number_of(pitch);
  if (distance === null || distance <= 0) return `pitch: is '${pitch}', must be a length above 0, in meters`;
  if (distance > longest_pitch) return `pitch: is ${distance} m, must be at most ${longest_pitch}; lengths are in meters`;
  if (kind === "checker") {
    return (Number(columns) + Number(rows)) % 2 === 0
      ? `a checkerboard of ${columns} x ${rows} inner corners looks the same when turned around; one side must be even and one odd` : "";
  }
  if (kind === "aprilgrid") {
    const tags = Number(columns) * Number(rows), gap = number_of(spacing);
    if (tags > all_tags) return `columns: ${columns} x ${rows} are ${tags} tags, must be at most ${all_tags}`;
    return gap !== null && gap >= least_spacing && gap <= most_spacing ? "" : `spacing: is '${spacing}', must be ${least_spacing} to ${most_spacing}, a share of the tag's size`;
  }
  const dot = number_of(radius);
  if (dot === null || dot <= 0) return `radius: is '${radius}', must be a length above 0, in meters`;
  return dot < distance / 2 ? "" : `radius: is ${dot} m, must be less than half the pitch, ${distance / 2} m`;
}

/// Of fields that are a target.
export function text_of({ kind, columns, rows, pitch, radius, spacing }: TargetFields): string {
  const size = `${Number(columns)}x${Number(rows)}`;
  if (kind === "aprilgrid") return `aprilgrid:${size}:${number_of(pitch)}:${number_of(spacing)}`;
  return kind === "dots" ? `dots:${size}:${number_of(pitch)}:${number_of(radius)}` : `checker:${size}:${number_of(pitch)}`;
}

/// The fields of a text form. What cannot be read of it is left empty, and so is no target.
export function fields_of(text: string): TargetFields {
  const [kind, size = "", pitch = "", last = ""] = text.trim().split(":");
  const [columns = "", rows = ""] = size.split("x");
  if (kind === "aprilgrid") return { kind, columns, rows, pitch, radius: first_target.radius, spacing: last };
  return { kind: kind === "checker" ? "checker" : "dots", columns, rows, pitch, radius: last, spacing: first_target.spacing };
}

/// "40 mm": a slip of the point is seen at once. Empty where there is no length.
export function in_millimeters(typed: string): string {
  const value = number_of(typed);
  return value === null ? "" : `${Number((1000 * value).toPrecision(4))} mm`;
}
