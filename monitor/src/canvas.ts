// A canvas as large as its place on the page, in the screen's own pixels.

/** Fits the canvas to its place; true when its size has changed. The screen's density counts up to 2. */
export function fit(canvas: HTMLCanvasElement): boolean {
  const density = Math.min(devicePixelRatio, 2);
  const width = Math.max(1, Math.round(canvas.clientWidth * density));
  const height = Math.max(1, Math.round(canvas.clientHeight * density));
  if (canvas.width === width && canvas.height === height) {
    return false;
  }
  canvas.width = width;
  canvas.height = height;
  return true;
}

export function context(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
  const found = canvas.getContext("2d");
  if (!found) {
    throw new Error("this browser has no 2D canvas");
  }
  return found;
}

export function element<T extends Element = HTMLElement>(selector: string): T {
  const found = document.querySelector<T>(selector);
  if (!found) {
    throw new Error(`the page has no ${selector}`);
  }
  return found;
}
