// How runs come nearer to their answer, iteration by iteration.

const curvesByRun = new Map(study.curves.drawn.map((curve) => [curve.run, curve]));
const milestonesByRun = new Map(
  study.curves.milestones.map(([run, half, most, within]) => [run, {half, most, within}]));
const kAllMethods = "";
const kAllWindows = "";
const picked = {series: null, place: null, window: kAllWindows};

const kCurveKinds = [
  {id: "curve-fitness", key: "fitness", title: "Fitness", note: "The best score, in the method's own unit.", words: (y) => significant(y, 4)},
  {id: "curve-ai", key: "ai", title: "Acceptance index", note: "Of the best pose.", words: (y) => digits(y, 4)},
  {id: "curve-error-m", key: "error_m", title: "Translation error", note: "Of the best pose, at the centre of the source's known cells. Logarithmic.", log: true, words: (y) => `${significant(y)} m`, tick: (y) => `${brief(y)} m`},
  {id: "curve-error-deg", key: "error_deg", title: "Rotation error", note: "Of the best pose. Logarithmic.", log: true, words: (y) => `${significant(y)}°`, tick: (y) => `${brief(y)}°`},
];

function drawConvergence(list) {
  const section = document.getElementById("convergence");
  const counted = list.filter((run) => milestonesByRun.has(run.run));
  if (counted.length === 0) {
    section.replaceChildren();
    return;
  }
  const curves = node("div", {id: "curves"});
  const pickers = node("div", {class: "pickers"});
  section.replaceChildren(
    node("h2", {}, "Convergence"),
    node("p", {class: "quiet"}, convergenceNote(counted)),
    pickers, curves, ...settledPart(counted), milestonesTable(counted),
  );
  drawPickers(pickers, curves, counted.filter((run) => curvesByRun.has(run.run)));
}

function convergenceNote(counted) {
  const drawn = study.curves.drawn.length, all = study.curves.milestones.length;
  const sample = drawn < all ? ` Drawn are ${whole(drawn)} of ${whole(all)} runs, spread evenly; counts and medians of iterations are of all.` : "";
  return `${plural(counted.length, "run", "runs")} with a curve.${sample}`;
}

// A place is a data set, or one pair of it where that has several runs to compare.
function placesOf(list) {
  const places = [];
  for (const [set, of] of groupBy(list, (run) => run.set)) {
    places.push({value: JSON.stringify([set]), words: `${set || "unnamed"}, all pairs`});
    const pairs = groupBy(of, (run) => run.pair);
    if (pairs.size > 1 && pairs.size <= 60) {
      for (const pair of pairs.keys()) {
        places.push({value: JSON.stringify([set, pair]), words: `${set} / ${pair}`});
      }
    }
  }
  return places;
}

const isAt = (run, place) => place === null || (run.set === place[0] && (place.length < 2 || run.pair === place[1]));

function drawPickers(pickers, curves, list) {
  const choose = (key, words, options, id) => {
    if (!options.some((option) => option.value === picked[key])) {
      picked[key] = options[0]?.value ?? null;
    }
    const select = node("select", {id, onchange: (event) => { picked[key] = event.target.value; refresh(); }},
      options.map((option) => node("option", {value: option.value, selected: option.value === picked[key]}, option.words)));
    return node("label", {}, [words, select]);
  };
  const refresh = () => {
    const series = seriesOf(list).map((name) => ({value: name, words: name}));
    const ofSeries = (run) => picked.series === kAllMethods || run.series === picked.series;
    const methods = choose("series", "Runs of", [...series, {value: kAllMethods, words: "all methods: medians only"}], "pick-series");
    const places = choose("place", "on", placesOf(list.filter(ofSeries)), "pick-place");
    const here = list.filter((run) => ofSeries(run) && isAt(run, JSON.parse(picked.place)));
    const windows = windowsInOrder(here).map((name) => ({value: name, words: windowWords(name)}));
    const all = windows.length > 1 ? [{value: kAllWindows, words: "all windows"}] : [];
    const focused = document.activeElement?.id;
    pickers.replaceChildren(methods, places, choose("window", "in window", [...all, ...windows], "pick-window"));
    document.getElementById(focused)?.focus();
    drawCurves(curves, here.filter((run) => picked.window === kAllWindows || run.window === picked.window));
  };
  if (list.length > 0) {
    refresh();
  }
}

function drawCurves(box, list) {
  endChartsIn(box);
  const few = list.length > 150 ? list.filter((_, i) => i % Math.ceil(list.length / 150) === 0) : list;
  box.replaceChildren(curveLegend(few), node("div", {class: "charts"}, kCurveKinds.map((kind) => curveFigure(kind, few))));
  startWaitingCharts();
}

function curveLegend(list) {
  if (picked.series === kAllMethods) {
    return legend(seriesOf(list));
  }
  const right = count(list, (run) => run.result === "right");
  return node("p", {class: "note"},
    `${plural(list.length, "run", "runs")}. Thin: each run, solid where it ended right (${right}), dashed grey where not (${list.length - right}). ` +
    "Thick: the median; a run that ended early keeps its last value.");
}

function curvePoints(curve, kind) {
  const points = [];
  for (let i = 0; i < curve.iteration.length; ++i) {
    const y = curve[kind.key][i];
    if (known(y)) {
      points.push({x: curve.iteration[i], y: kind.log ? Math.max(y, 1e-3) : y});
    }
  }
  return points;
}

function thinLine(run, kind) {
  const right = run.result === "right";
  const colour = right ? look(run.series).colour : colours.quiet;
  const alpha = right ? "80" : "70";
  return {
    data: curvePoints(curvesByRun.get(run.run), kind), borderColor: colour + alpha, borderWidth: 1,
    borderDash: right ? [] : [4, 3], pointRadius: 0, pointHitRadius: 0, showLine: true,
  };
}

function medianLine(series, list, kind, colour) {
  const points = medianCurve(list.map((run) => curvesByRun.get(run.run)), kind.key);
  return {
    ...seriesStyle(series, 0), borderColor: colour, borderDash: picked.series === kAllMethods ? look(series).dash : [],
    borderWidth: 3, pointHitRadius: 6, showLine: true,
    data: points.map(({x, y}) => ({x, y: kind.log ? Math.max(y, 1e-3) : y, words: [series, `median of ${list.length} runs`, `iteration ${x}: ${kind.words(y)}`]})),
  };
}

function curveFigure(kind, list) {
  const some = list.some((run) => curvesByRun.get(run.run)[kind.key].some(known));
  const medians = () => [...groupBy(list, (run) => run.series)].map(([series, of]) =>
    medianLine(series, of, kind, picked.series === kAllMethods ? look(series).colour : colours.ink));
  const thin = () => (picked.series === kAllMethods ? [] : list.map((run) => thinLine(run, kind)));
  return chartFigure({
    id: kind.id, title: kind.title, note: kind.note,
    chart: !some ? null : () => ({
      type: "scatter",
      data: {datasets: [...medians(), ...thin()]},  // the first lies on top
      options: {scales: {
        x: axis("iteration", {min: 0, ticks: {maxTicksLimit: 8}}),
        y: kind.log ? logAxis("", kind.tick, list.flatMap((run) => curvePoints(curvesByRun.get(run.run), kind).map(({y}) => y))) : axis(""),
      }},
    }),
  });
}

// The share of runs that have settled within the tolerance, by iteration.
function settledPart(counted) {
  const same = counted.filter((run) => run.truth === "same");
  if (same.length === 0) {
    return [];
  }
  const line = (series, own) => {
    const at = own.map((run) => milestonesByRun.get(run.run).within).filter(known).sort((a, b) => a - b);
    const last = own.reduce((most, run) => Math.max(most, run.iterations), at[at.length - 1] ?? 0);
    const share = (k) => ({x: at[k], y: (100 * (k + 1)) / own.length,
      words: [series, `${k + 1} of ${own.length} within tolerance`, `from iteration ${at[k]} on`]});
    return [{x: 0, y: 0}, ...at.map((_, k) => share(k)), {x: last, y: (100 * at.length) / own.length}];
  };
  const groups = [...groupBy(same, (run) => run.series)];
  return [
    legend(seriesOf(same)),
    node("div", {class: "charts"}, chartFigure({
      id: "settled", title: "Within tolerance by iteration", wide: true,
      note: "Of the runs on maps that share something: from that iteration on, both errors of the best pose are within the pair's tolerance.",
      chart: () => ({
        type: "scatter",
        data: {datasets: groups.map(([series, own]) => ({
          ...seriesStyle(series, 0), pointHitRadius: 5, showLine: true, stepped: "before", data: thinned(line(series, own), 600)}))},
        options: {scales: {x: axis("iteration", {min: 0}), y: percentAxis("of runs")}},
      }),
    })),
  ];
}

function milestonesTable(counted) {
  const groups = groupBy(counted, (run) => JSON.stringify([run.series, run.set, run.window]));
  const rows = [...groups.values()].map((of) => {
    const reached = (key) => spread(of.map((run) => milestonesByRun.get(run.run)[key]));
    const cost = spread(of.filter((run) => run.iterations > 0).map(iterationCost)).median;
    return {
      first: of[0], n: of.length, same: count(of, (run) => run.truth === "same"), half: reached("half"), most: reached("most"), within: reached("within"), cost,
      iterations: spread(of.map((run) => run.iterations)).median,
      windowPlace: windowSize(of[0]),
    };
  });
  rows.sort((a, b) => seriesPlace.get(a.first.series) - seriesPlace.get(b.first.series) ||
    kCompareTexts(a.first.set, b.first.set) || (a.windowPlace === b.windowPlace ? 0 : a.windowPlace - b.windowPlace));
  const middle = (name, key, title) => ({name, title, value: (row) => row[key].median, cell: (row) => rangeCell(row[key])});
  return table({
    id: "milestones-table",
    caption: "Iterations to convergence: medians, in brackets from the least to the most. Fitness is compared with the run's own at its end.",
    rows,
    columns: [
      {name: "Method", text: true, value: (row) => row.first.series, cell: (row) => seriesLabel(row.first.series)},
      {name: "Data set", text: true, value: (row) => row.first.set},
      {name: "Window", text: true, value: (row) => row.windowPlace, cell: (row) => windowWords(row.first.window)},
      {name: "Runs", value: (row) => row.n},
      {name: "Within tolerance", title: "At the end of the search, of the runs on maps that share something", value: (row) => (row.same ? row.within.n / row.same : null), cell: (row) => (row.same ? `${row.within.n} of ${row.same}` : kNone)},
      middle("Half the fitness at", "half"), middle("90 % at", "most"), middle("Within tolerance at", "within"),
      {name: "Iterations", value: (row) => row.iterations, cell: (row) => whole(row.iterations)},
      {name: "An iteration", value: (row) => row.cost, cell: (row) => duration(row.cost)},
      {name: "Time to tolerance", title: "Median iteration times median cost", value: (row) => timeTo(row), cell: (row) => duration(timeTo(row))},
    ],
  });
}

const timeTo = (row) => (known(row.within.median) && known(row.cost) ? row.within.median * row.cost : null);

function rangeCell(values) {
  if (values.n === 0) {
    return kNone;
  }
  return node("span", {}, [whole(values.median), " ", node("span", {class: "range"}, `(${values.least}–${values.worst})`)]);
}
