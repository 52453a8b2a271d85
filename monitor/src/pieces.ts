// Polylines in pieces: no line spans the gap between two days of a schedule, which has no frames.

/** Points in the order of their frames, cut before each of `begins`. */
export function pieces<P>(points: readonly P[], frame: (point: P) => number, begins: readonly number[]): P[][] {
  const cut: P[][] = [];
  let day = -1;
  for (const point of points) {
    const own = begins.filter((begin) => begin <= frame(point)).length;
    if (own !== day) {
      cut.push([]);
      day = own;
    }
    cut[cut.length - 1]!.push(point);
  }
  return cut;
}
