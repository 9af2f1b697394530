/// Holds the newest value that nobody has taken yet; older ones are dropped and counted, never queued.
export class Newest<T> {
  private value: T | null = null;
  dropped = 0;

  put(value: T): void {
    if (this.value !== null) ++this.dropped;
    this.value = value;
  }

  take(): T | null {
    const value = this.value;
    this.value = null;
    return value;
  }
}

/// Decodes one value at a time; what comes meanwhile waits in a `Newest`, so results keep their order and a slow decoder only lowers
/// the rate, never the freshness.
export class NewestDecoder<In, Out> {
  private readonly waiting = new Newest<In>();
  private busy = false;
  /// Values that could not be decoded.
  broken = 0;

  constructor(private readonly decode: (value: In) => Promise<Out>, private readonly done: (result: Out) => void) {}

  get dropped(): number {
    return this.waiting.dropped;
  }

  put(value: In): void {
    this.waiting.put(value);
    if (!this.busy) void this.work();
  }

  private async work(): Promise<void> {
    this.busy = true;
    for (let value = this.waiting.take(); value !== null; value = this.waiting.take()) {
      try {
        this.done(await this.decode(value));
      } catch {
        ++this.broken;
      }
    }
    this.busy = false;
  }
}
