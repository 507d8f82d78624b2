// Whether the confidence tells right poses from others.

function drawConfidence(list) {
  const section = document.getElementById("confidence");
  const rocs = seriesOf(list.filter(isPair)).map((series) => {
    const own = list.filter((run) => run.series === series);
    return {series, own, roc: rocOf(own)};
  }).filter(({roc}) => roc.points.length > 1);
  if (rocs.length === 0) {
    section.replaceChildren();
    return;
  }
  section.replaceChildren(
    node("h2", {}, "Confidence"),
    node("p", {class: "quiet"}, "Every answer with its confidence, whatever the verdict. Its first pose is right, or it is not: elsewhere, or the maps share nothing. An answer is accepted where its confidence reaches a threshold."),
    legend(rocs.map(({series}) => series)),
    node("div", {class: "charts"}, [rocFigure(rocs), acceptedFigure(rocs)]),
    rocTable(rocs),
  );
}

function rocPoints(roc) {
  return roc.points.map((point) => ({
    x: 100 * point.falsePositive, y: 100 * point.truePositive,
    words: [thresholdWords(point), `${percent(point.truePositive)} of the right ones accepted`,
            `${percent(point.falsePositive)} of the others accepted`],
  }));
}

// Where the verdict stands, which looks at more than the confidence.
function verdictPoint(series, own, roc) {
  const merged = judgedRuns(own).filter((run) => run.status === "merged");
  const right = count(merged, hasRightPose);
  const wrong = merged.length - right;
  return {
    x: (100 * wrong) / roc.negatives, y: (100 * right) / roc.positives,
    words: [`${series}: the verdict`, `merged ${right} of ${roc.positives} right ones`, `and ${wrong} of ${roc.negatives} others`],
  };
}

const thresholdWords = (point) =>
  point.threshold === Infinity ? "nothing accepted" : `confidence from ${digits(point.threshold, 3)}`;

// Many answers make many points that look like one line: as many are drawn as a screen can show.
function thinned(points, most = 400) {
  if (points.length <= most) {
    return points;
  }
  const step = (points.length - 1) / (most - 1);
  return Array.from({length: most}, (_, i) => points[Math.round(i * step)]);
}

function rocFigure(rocs) {
  const both = rocs.filter(({roc}) => roc.area !== null);
  return chartFigure({
    id: "roc", title: "ROC",
    note: both.length ? "Marks: what the verdict itself merged. Dashed grey: a coin." : "There must be right answers and others to draw this.",
    chart: both.length === 0 ? null : () => ({
      type: "scatter",
      data: {datasets: [
        ...both.map(({series, roc}) => ({...seriesStyle(series, 0), pointHitRadius: 6, showLine: true, data: thinned(rocPoints(roc))})),
        ...both.map(({series, own, roc}) => ({...seriesStyle(series, 5.5), showLine: false, data: [verdictPoint(series, own, roc)]})),
        {label: "coin", data: [{x: 0, y: 0}, {x: 100, y: 100}], showLine: true, borderColor: colours.quiet, borderDash: [4, 4], borderWidth: 1, pointRadius: 0, pointHitRadius: 0},
      ]},
      options: {scales: {x: percentAxis("of the others, accepted"), y: percentAxis("of the right ones, accepted")}},
    }),
    numbers: rocNumbers(both),
  });
}

const kThresholds = [0.5, 0.7, 0.8, 0.9, 0.95, 0.99];

// What is accepted from a threshold on.
function acceptedFrom(roc, threshold) {
  let last = roc.points[0];
  for (const point of roc.points) {
    if (point.threshold < threshold) {
      break;
    }
    last = point;
  }
  return last;
}

const rocNumbers = (rocs) => ({
  caption: "What is accepted from some thresholds on",
  rows: rocs.flatMap(({series, roc}) => kThresholds.map((asked) => ({series, asked, ...acceptedFrom(roc, asked)})))
    .map((row) => ({...row, falseShare: wilson(row.wrong, row.right + row.wrong)})),
  columns: [
    {name: "Method", text: true, value: (row) => row.series, cell: (row) => seriesLabel(row.series)},
    {name: "Threshold", value: (row) => row.asked},
    {name: "Right accepted", value: (row) => row.right},
    {name: "Others accepted", value: (row) => row.wrong},
    {name: "Others among the accepted", value: (row) => row.falseShare.share, cell: (row) => shareCell(row.falseShare)},
  ],
});

function acceptedFigure(rocs) {
  const points = ({points: all}) => all.slice(1).map((point) => ({
    x: point.threshold, y: (100 * point.wrong) / (point.right + point.wrong),
    words: [thresholdWords(point), `${point.wrong} of ${point.right + point.wrong} accepted are not right`],
  }));
  return chartFigure({
    id: "false-merges", title: "False merges by threshold",
    note: "Of the answers accepted at a threshold, the share that is not right. Less is better.",
    chart: () => ({
      type: "scatter",
      data: {datasets: rocs.map(({series, roc}) => ({...seriesStyle(series, 0), pointHitRadius: 6, showLine: true, data: thinned(points(roc))}))},
      options: {scales: {
        x: axis("threshold of the confidence", {min: 0, max: 1}),
        y: axis("not right, of the accepted", {beginAtZero: true, ticks: {callback: (value) => `${significant(value, 2)} %`}}),
      }},
    }),
  });
}

function rocTable(rocs) {
  const merged = ({own}) => own.filter((run) => run.status === "merged" && run.result !== "unknown" && isPair(run));
  const rows = rocs.map((entry) => ({
    ...entry,
    falseMerges: wilson(count(merged(entry), (run) => run.result !== "right"), merged(entry).length),
  }));
  return table({
    id: "confidence-table",
    caption: "Area under the ROC curve (1: perfect, 0.5: a coin), and what the verdict itself accepted.",
    rows,
    columns: [
      {name: "Method", text: true, value: (row) => row.series, cell: (row) => seriesLabel(row.series)},
      {name: "Right poses", value: (row) => row.roc.positives, cell: (row) => whole(row.roc.positives)},
      {name: "Others", value: (row) => row.roc.negatives, cell: (row) => whole(row.roc.negatives)},
      {name: "Area", value: (row) => row.roc.area, cell: (row) => digits(row.roc.area, 4)},
      {name: "Merged", value: (row) => row.falseMerges.n, cell: (row) => whole(row.falseMerges.n)},
      {name: "Not right among the merged", value: (row) => row.falseMerges.share, cell: (row) => shareCell(row.falseMerges)},
    ],
  });
}
