import { useEffect, useState } from "preact/hooks";

/// A value that tells when it was replaced.
export class Observable<T> {
  private readonly listeners = new Set<() => void>();

  constructor(private current: T) {}

  get value(): T {
    return this.current;
  }

  set(value: T): void {
    if (Object.is(value, this.current)) return;
    this.current = value;
    for (const listener of [...this.listeners]) listener();
  }

  /// Returns what ends it.
  subscribe(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }
}

/// The value in a component, which is shown anew when it was replaced.
export function useValue<T>(observable: Observable<T>): T {
  const [value, set] = useState(observable.value);
  useEffect(() => {
    const update = (): void => set(() => observable.value);
    update();   // it may have been replaced between first show and subscription
    return observable.subscribe(update);
  }, [observable]);
  return value;
}
