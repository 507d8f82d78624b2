// How often the right pose was found, by what makes it easy or hard.

const kBands = [[0, 0.1], [0.1, 0.2], [0.2, 0.3], [0.3, 0.5], [0.5, 0.7], [0.7, 1.0001]];

function drawSuccess(list) {
  const section = document.getElementById("success");
  const pairs = list.filter(isPair);
  const same = pairs.filter((run) => ["right", "wrong", "missed"].includes(run.result));
  const different = pairs.filter((run) => ["refused", "false"].includes(run.result));
  if (same.length + different.length === 0) {
    section.replaceChildren();
    return;
  }
  const series = seriesOf(pairs);
  section.replaceChildren(
    node("h2", {}, "Success"),
    node("p", {class: "quiet"}, "The share of runs that ended right, of those on maps that share something. Lines across a mark: Wilson's 95 % interval."),
    node("p", {class: "note"}, sameInAll(same)),
    legend(series),
    node("div", {class: "charts"}, [
      setsFigure("success-by-set", "By data set", "Right, of the maps that share something.", same, "right"),
      setsFigure("false-by-set", "False merges by data set", "Merged, of the maps that share nothing. Less is better.", different, "false"),
      stepsFigure("success-by-overlap", "By overlap", "Share of the source's known area that the target knows.", "overlap", same, overlapBands()),
      stepsFigure("success-by-window", "By search window", "From the narrowest to the widest.", "window", same, windowSteps(same)),
      stepsFigure("success-by-noise", "By range noise", "Standard deviation of a range.", "noise", same, valueSteps(same, "noise_m", (v) => `${brief(v)} m`)),
      stepsFigure("success-by-drift", "By drift", "As the scenes define it, after a metre.", "drift", same, valueSteps(same, "drift", (v) => `${brief(v)} m`)),
    ].filter(Boolean)),
  );
}

// What does not vary has no chart.
function sameInAll(list) {
  const only = (key, words) => {
    const values = distinct(list.filter((run) => run[key] !== null), (run) => run[key]);
    return values.length === 1 ? [words(values[0])] : [];
  };
  const constants = [
    ...only("window", (name) => `window ${windowWords(name)}`),
    ...only("noise_m", (value) => `range noise ${brief(value)} m`),
    ...only("drift", (value) => `drift ${brief(value)} m`),
  ];
  return constants.length ? `The same in all these runs: ${constants.join(", ")}.` : "";
}

// In the order that their colours have.
function seriesOf(list) {
  return distinct(list, (run) => run.series).sort((a, b) => seriesPlace.get(a) - seriesPlace.get(b));
}

// A step: {name, holds(run)}. Steps without runs are left out by whoever draws them.
function overlapBands() {
  return kBands.map(([low, high]) => ({
    name: `${Math.round(100 * low)}–${Math.round(100 * Math.min(1, high))} %`,
    holds: (run) => known(run.overlap) && run.overlap >= low && run.overlap < high,
  }));
}

function windowSteps(list) {
  return windowsInOrder(list).map((name) => ({name: windowWords(name), holds: (run) => run.window === name}));
}

// One step a value; where there are many values, six steps with as many runs in each.
function valueSteps(list, key, words) {
  const values = distinct(list.filter((run) => known(run[key])), (run) => run[key]).sort((a, b) => a - b);
  if (values.length <= 8) {
    return values.map((value) => ({name: words(value), holds: (run) => run[key] === value}));
  }
  const all = list.map((run) => run[key]).filter(known).sort((a, b) => a - b);
  const edges = [...new Set([0, 1, 2, 3, 4, 5, 6].map((i) => quantile(all, i / 6)))];
  return edges.slice(1).map((high, i) => ({
    name: `to ${words(high)}`,
    holds: (run) => known(run[key]) && (i === 0 || run[key] > edges[i]) && run[key] <= high,
  }));
}

// Counts of each series in each step: what a chart and its numbers show.
function shareCells(list, steps, result) {
  const cells = [];
  for (const step of steps) {
    for (const [series, of] of groupBy(list.filter(step.holds), (run) => run.series)) {
      cells.push({step: step.name, series, share: wilson(count(of, (run) => run.result === result), of.length)});
    }
  }
  return cells;
}

const cellFinder = (cells) => {
  const found = new Map(cells.map((cell) => [`${cell.step}\n${cell.series}`, cell]));
  return (series, step) => found.get(`${step}\n${series}`) ?? null;
};

function sharePoint(cell, along) {
  if (cell === null) {
    return null;
  }
  const {share} = cell;
  return {
    [along]: 100 * share.share, low: 100 * share.low, high: 100 * share.high,
    words: [`${cell.series}, ${cell.step}`, `${percent(share.share)} (${interval(share)})`, `${share.successes} of ${share.n}`],
  };
}

const shareNumbers = (caption, stepName, what, cells) => ({
  caption,
  rows: cells,
  columns: [
    {name: stepName, text: true, value: (cell) => cell.step},
    {name: "Method", text: true, value: (cell) => cell.series, cell: (cell) => seriesLabel(cell.series)},
    {name: "Runs", value: (cell) => cell.share.n},
    {name: what, value: (cell) => cell.share.successes},
    {name: "Share (95 %)", value: (cell) => cell.share.share, cell: (cell) => shareCell(cell.share)},
  ],
});

function setsFigure(id, title, note, list, result) {
  const names = distinct(list, (run) => run.set).sort(kCompareTexts);
  const cells = shareCells(list, names.map((name) => ({name, holds: (run) => run.set === name})), result);
  if (cells.length === 0) {
    return null;
  }
  const find = cellFinder(cells);
  const series = seriesOf(list);
  return chartFigure({
    id, title, note, height: rowsHeight(names, series),
    chart: () => rowsChart({names, series, point: (s, name) => sharePoint(find(s, name), "x"), xAxis: percentAxis("")}),
    numbers: shareNumbers(title, "Data set", result === "right" ? "Right" : "False", cells),
  });
}

function stepsFigure(id, title, note, stepName, list, steps) {
  const cells = shareCells(list, steps, "right");
  const there = steps.map((step) => step.name).filter((name) => cells.some((cell) => cell.step === name));
  if (there.length < 2) {
    return null;  // one step says no more than the table of methods
  }
  const find = cellFinder(cells);
  return chartFigure({
    id, title, note,
    chart: () => stepsChart({
      names: there, series: seriesOf(list), xTitle: stepName, yAxis: percentAxis("right"),
      point: (s, name) => sharePoint(find(s, name), "y"),
    }),
    numbers: shareNumbers(title, title.replace("By ", ""), "Right", cells),
  });
}
