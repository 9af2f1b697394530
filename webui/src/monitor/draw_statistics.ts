/// How often the field was drawn, for those who measure it.
export class DrawStatistics {
  private readonly times: number[] = [];
  drawn = 0;
  /// How long the last ones took, mean of about 20. [ms]
  mean_ms = 0;

  constructor(private readonly remembered_ms = 5000) {}

  add(now: number, took_ms: number): void {
    this.mean_ms = this.drawn === 0 ? took_ms : this.mean_ms + (took_ms - this.mean_ms) / 20;
    ++this.drawn;
    this.times.push(now);
    while (this.times[0]! < now - this.remembered_ms) this.times.shift();
  }

  /// Of the last second.
  per_second(now: number): number {
    return this.times.filter((time) => time > now - 1000).length;
  }

  /// Between two drawings of the last seconds, or since the last one, [ms].
  longest_gap_ms(now: number): number {
    return this.times.reduce((longest, time, i) => Math.max(longest, (this.times[i + 1] ?? now) - time), 0);
  }
}
