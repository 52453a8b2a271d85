// A canvas that fills its box on the page, in device pixels.

/** Sizes on the page. Asked of the page at every picture, they would have it laid out again each time. */
const sizes = new WeakMap<Element, { width: number; height: number }>();
const observer = new ResizeObserver((entries) => {
  for (const { target, contentRect } of entries) {
    sizes.set(target, contentRect);
  }
  resized();
});
let resized: () => void = () => undefined;

/** Calls back when a canvas has another size on the page than it was drawn with. */
export function onResize(callback: () => void): void {
  resized = callback;
}

function sizeOf(canvas: HTMLCanvasElement): { width: number; height: number } {
  let size = sizes.get(canvas);
  if (!size) {
    size = { width: canvas.clientWidth, height: canvas.clientHeight };
    sizes.set(canvas, size);
    observer.observe(canvas);
  }
  return size;
}

/** Fits the canvas to its place; true when its size has changed. The screen's density counts up to 2. */
export function fit(canvas: HTMLCanvasElement): boolean {
  const density = Math.min(devicePixelRatio, 2);
  const size = sizeOf(canvas);
  const width = Math.max(1, Math.round(size.width * density));
  const height = Math.max(1, Math.round(size.height * density));
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
