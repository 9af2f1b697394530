/// A WebSocket that is opened again whenever it closes.

export type ChannelState =
  | { readonly kind: "connecting" }
  | { readonly kind: "open" }
  | { readonly kind: "waiting"; readonly until: number }
  | { readonly kind: "closed" };

/// The part of WebSocket that is used.
export interface Socket {
  binaryType: string;
  onopen: (() => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: (() => void) | null;
  close(): void;
}

/// What a channel takes from its surroundings; tests bring their own.
export interface ChannelWorld {
  open(): Socket;
  now(): number;
  after(ms: number, call: () => void): () => void;
}

export const first_delay_ms = 500;
export const longest_delay_ms = 8000;

/// Before the n-th try in a row without a message, n from 0, [ms]. Doubles up to a bound.
export function delay_before(attempt: number): number {
  return Math.min(first_delay_ms * 2 ** attempt, longest_delay_ms);
}

/// Messages in order, from one socket at a time; what an older socket still says is ignored. Delays begin anew after a message,
/// not after a mere connection: a server that accepts and hangs up at once is not to be asked at full speed.
export class Channel {
  private socket: Socket | null = null;
  private cancel: (() => void) | null = null;
  private attempt = 0;
  state: ChannelState = { kind: "closed" };

  constructor(
    private readonly world: ChannelWorld,
    private readonly message: (data: unknown) => void,
    private readonly changed: (state: ChannelState) => void,
    /// As binary messages come. A blob passes through more hands, but is not copied before it is wanted.
    private readonly binary: "blob" | "arraybuffer" = "blob",
  ) {}

  start(): void {
    if (this.state.kind === "closed") this.connect();
  }

  stop(): void {
    this.cancel?.();
    this.cancel = null;
    const socket = this.socket;
    this.socket = null;
    socket?.close();
    this.set({ kind: "closed" });
  }

  /// Does not wait any longer.
  retry(): void {
    if (this.state.kind !== "waiting") return;
    this.cancel?.();
    this.connect();
  }

  private connect(): void {
    this.cancel = null;
    let socket: Socket;
    try {
      socket = this.world.open();
    } catch {
      this.wait();
      return;
    }
    this.socket = socket;
    socket.binaryType = this.binary;
    socket.onopen = () => {
      if (this.socket === socket) this.set({ kind: "open" });
    };
    socket.onmessage = (event) => {
      if (this.socket !== socket) return;
      this.attempt = 0;
      this.message(event.data);
    };
    socket.onclose = () => {
      if (this.socket !== socket) return;
      this.socket = null;
      this.wait();
    };
    this.set({ kind: "connecting" });
  }

  private wait(): void {
    const delay = delay_before(this.attempt++);
    this.cancel = this.world.after(delay, () => this.connect());
    this.set({ kind: "waiting", until: this.world.now() + delay });
  }

  private set(state: ChannelState): void {
    this.state = state;
    this.changed(state);
  }
}

/// Of the server that the page came from.
export function browser_world(path: string): ChannelWorld {
  return {
    open: () => new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}${path}`) as unknown as Socket,
    now: () => performance.now(),
    after: (ms, call) => {
      const timer = setTimeout(call, ms);
      return () => clearTimeout(timer);
    },
  };
}
