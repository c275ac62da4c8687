// A state that tells those who listen when it has changed.

import { useEffect, useState } from "preact/hooks";

export class Observed {
  private listeners = new Set<() => void>();

  listen(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  protected change(what: () => void) {
    what();
    for (const listener of this.listeners) listener();
  }
}

/** Draws a component again at each change of a state. */
export function useObserved(state: Observed) {
  const [, draw] = useState(0);
  useEffect(() => state.listen(() => draw((count) => count + 1)), [state]);
}
