// Counts and spreads. A list without numbers has the median null.

// Wilson's interval for a share of successes, 95 %.
function wilson(successes, n) {
  if (n === 0) {
    return {share: null, low: null, high: null, successes, n};
  }
  const z = 1.959964;
  const share = successes / n;
  const middle = (share + (z * z) / (2 * n)) / (1 + (z * z) / n);
  const half = (z / (1 + (z * z) / n)) * Math.sqrt((share * (1 - share)) / n + (z * z) / (4 * n * n));
  return {share, low: Math.max(0, middle - half), high: Math.min(1, middle + half), successes, n};
}

// Between the two nearest, as R's type 7. `sorted` ascends.
function quantile(sorted, q) {
  if (sorted.length === 0) {
    return null;
  }
  const at = (sorted.length - 1) * q;
  const below = Math.floor(at);
  const above = Math.min(below + 1, sorted.length - 1);
  return sorted[below] + (sorted[above] - sorted[below]) * (at - below);
}

function spread(values) {
  const sorted = values.filter(known).sort((a, b) => a - b);
  return {
    n: sorted.length,
    least: sorted.length ? sorted[0] : null,
    lower: quantile(sorted, 0.25),
    median: quantile(sorted, 0.5),
    upper: quantile(sorted, 0.75),
    worst: sorted.length ? sorted[sorted.length - 1] : null,
  };
}

const count = (list, holds) => list.reduce((sum, item) => sum + (holds(item) ? 1 : 0), 0);

// Of pairs that share something: found or not. Of pairs that share nothing: merged all the same or not.
function outcomes(list) {
  const of = (result) => count(list, (run) => run.result === result);
  const right = of("right"), wrong = of("wrong"), missed = of("missed"), refused = of("refused"), merged = of("false");
  const same = right + wrong + missed;
  const different = refused + merged;
  return {
    runs: list.length, same, different, right, wrong, missed, refused, false: merged,
    unknown: list.length - same - different,
    rightShare: wilson(right, same), wrongShare: wilson(wrong, same), missedShare: wilson(missed, same),
    falseShare: wilson(merged, different),
  };
}

// Runs that tell something of the confidence, and whether their first pose is right, whatever the verdict.
const judgedRuns = (list) => list.filter((run) => isPair(run) && known(run.confidence) && run.truth !== "unknown");
const hasRightPose = (run) => run.truth === "same" && run.pose_right === 1;

// Confidence as a test of the pose: an answer is accepted where its confidence is at least a threshold.
// Points from the strictest threshold to the loosest, with what is accepted at each.
function rocOf(list) {
  const judged = judgedRuns(list);
  const positives = count(judged, hasRightPose);
  const negatives = judged.length - positives;
  const sorted = [...judged].sort((a, b) => b.confidence - a.confidence);
  const points = [{threshold: Infinity, right: 0, wrong: 0, truePositive: 0, falsePositive: 0}];
  let right = 0, wrong = 0, area = 0;
  for (let i = 0; i < sorted.length; ) {
    const threshold = sorted[i].confidence;
    const before = points[points.length - 1];
    for (; i < sorted.length && sorted[i].confidence === threshold; ++i) {
      hasRightPose(sorted[i]) ? ++right : ++wrong;
    }
    const point = {
      threshold, right, wrong,
      truePositive: positives ? right / positives : 0, falsePositive: negatives ? wrong / negatives : 0,
    };
    area += ((point.falsePositive - before.falsePositive) * (point.truePositive + before.truePositive)) / 2;
    points.push(point);
  }
  return {points, positives, negatives, area: positives && negatives ? area : null};
}

// Least squares y = offset + slope x.
function lineThrough(points) {
  const n = points.length;
  if (n < 3) {
    return null;
  }
  const mean = (of) => points.reduce((sum, point) => sum + of(point), 0) / n;
  const x = mean((p) => p.x), y = mean((p) => p.y);
  const sum = (of) => points.reduce((total, point) => total + of(point), 0);
  const xx = sum((p) => (p.x - x) ** 2), xy = sum((p) => (p.x - x) * (p.y - y)), yy = sum((p) => (p.y - y) ** 2);
  if (xx === 0) {
    return null;
  }
  const slope = xy / xx;
  return {slope, offset: y - slope * x, r2: yy === 0 ? null : (xy * xy) / (xx * yy), n};
}

// The median over several curves at each iteration. A run that ended early keeps its last value.
function medianCurve(curves, valueName) {
  const last = Math.max(...curves.map((curve) => curve.iteration[curve.iteration.length - 1]));
  const steps = Math.min(last, 240);
  const points = [];
  const places = curves.map(() => 0);
  for (let step = 0; step <= steps; ++step) {
    const iteration = steps === 0 ? last : Math.round((last * step) / steps);
    const values = [];
    curves.forEach((curve, c) => {
      while (places[c] + 1 < curve.iteration.length && curve.iteration[places[c] + 1] <= iteration) {
        ++places[c];
      }
      if (curve.iteration[places[c]] <= iteration && known(curve[valueName][places[c]])) {
        values.push(curve[valueName][places[c]]);
      }
    });
    const median = quantile(values.sort((a, b) => a - b), 0.5);
    if (median !== null) {
      points.push({x: iteration, y: median});
    }
  }
  return points;
}
