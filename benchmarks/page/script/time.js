// What a run costs. A wrong answer is never timed in with the right ones.

const durationTick = (seconds) => duration(seconds, brief);
const isRightAnswer = (run) => run.result === "right" || run.result === "refused";

function drawTime(list) {
  const section = document.getElementById("time");
  const pairs = list.filter((run) => isPair(run) && known(run.align_s));
  if (pairs.length === 0) {
    section.replaceChildren();
    return;
  }
  section.replaceChildren(
    node("h2", {}, "Time"),
    node("p", {class: "quiet"}, "Wall-clock time of a run without reading files, of runs that answered right: merged where it belongs, or refused where nothing is shared."),
    legend(seriesOf(pairs)),
    node("div", {class: "charts"}, [timeFigure(pairs), sizeFigure(pairs), iterationFigure(pairs)].filter(Boolean)),
    stepsTable(pairs),
  );
}

function timeRows(list) {
  return seriesOf(list).map((series) => {
    const own = list.filter((run) => run.series === series);
    const right = own.filter(isRightAnswer);
    const step = (key) => spread(right.map((run) => run[key])).median;
    return {
      series, right: spread(right.map((run) => run.align_s)),
      other: spread(own.filter((run) => !isRightAnswer(run)).map((run) => run.align_s)),
      prepare: step("prepare_s"), propose: step("propose_s"), refine: step("refine_s"), judge: step("judge_s"),
      yardsticks: spread(right.filter((run) => run.yardstick_s > 0).map((run) => run.align_s / run.yardstick_s)).median,
    };
  });
}

function timeFigure(list) {
  const rows = timeRows(list).filter((row) => row.right.n > 0);
  const names = rows.map((row) => row.series);
  const of = new Map(rows.map((row) => [row.series, row.right]));
  if (rows.length === 0) {
    return null;
  }
  const point = (series, name) => {
    if (series !== name) {
      return null;
    }
    const time = of.get(series);
    return {
      x: time.median, low: time.least, high: time.worst, lower: time.lower, upper: time.upper,
      words: [series, `median ${duration(time.median)}`, `quartiles ${duration(time.lower)}, ${duration(time.upper)}`,
              `from ${duration(time.least)} to ${duration(time.worst)}`, `${time.n} runs`],
    };
  };
  return chartFigure({
    id: "time-by-method", title: "By method", wide: true, height: 76 + 30 * names.length,
    note: "Mark: median. Thick: between the quartiles. Thin: from the fastest to the slowest.",
    chart: () => {
      const config = rowsChart({names, series: names, point, xAxis: logAxis("", durationTick, rows.flatMap(({right}) => [right.least, right.worst]))});
      // One series a row: nothing to set apart.
      config.data.datasets.forEach((dataset, at) => dataset.data.forEach((p) => { p.y = at; }));
      return config;
    },
    numbers: timeNumbers(rows),
  });
}

const timeNumbers = (rows) => ({
  caption: "Time of right answers",
  rows,
  columns: [
    {name: "Method", text: true, value: (row) => row.series, cell: (row) => seriesLabel(row.series)},
    {name: "Runs", value: (row) => row.right.n},
    ...[["Fastest", "least"], ["Lower quartile", "lower"], ["Median", "median"], ["Upper quartile", "upper"], ["Slowest", "worst"]]
      .map(([name, key]) => ({name, value: (row) => row.right[key], cell: (row) => duration(row.right[key])})),
  ],
});

function stepsTable(list) {
  const step = (name, key) => ({name, value: (row) => row[key], cell: (row) => duration(row[key])});
  return table({
    id: "time-table",
    caption: "Where the time goes: medians of right answers. Yardsticks: the run's time over that of a fixed piece of work, timed beside it.",
    rows: timeRows(list),
    columns: [
      {name: "Method", text: true, value: (row) => row.series, cell: (row) => seriesLabel(row.series)},
      {name: "Right", title: "Right answers", value: (row) => row.right.n, cell: (row) => whole(row.right.n)},
      {name: "Median", value: (row) => row.right.median, cell: (row) => duration(row.right.median)},
      {name: "Slowest", value: (row) => row.right.worst, cell: (row) => duration(row.right.worst)},
      step("Prepare", "prepare"), step("Propose", "propose"), step("Refine", "refine"), step("Judge", "judge"),
      {name: "Yardsticks", value: (row) => row.yardsticks, cell: (row) => significant(row.yardsticks)},
      {name: "Others", title: "Wrong, missed, false or unknown", value: (row) => row.other.n, cell: (row) => whole(row.other.n)},
      {name: "Their median", value: (row) => row.other.median, cell: (row) => duration(row.other.median)},
    ],
  });
}

// A cloud of points a series. Crowds are drawn faint.
function cloudStyle(series, n) {
  const style = seriesStyle(series, n > 1500 ? 1.75 : 2.75);
  const alpha = n > 1500 ? "99" : "cc";
  return {...style, showLine: false, backgroundColor: style.borderColor + alpha, borderColor: style.borderColor + alpha, pointBorderWidth: 1};
}

function sizeFigure(list) {
  const sized = list.filter((run) => run.target_walls + run.source_walls > 0 && run.align_s > 0);
  if (sized.length === 0) {
    return null;
  }
  const point = (run) => ({
    x: run.target_walls + run.source_walls, y: run.align_s,
    words: [run.series, `${run.set} ${run.pair}`, `${whole(run.target_walls + run.source_walls)} occupied cells, ${duration(run.align_s)}`],
  });
  return chartFigure({
    id: "time-by-size", title: "Against the size of the maps", note: "Each run; occupied cells of both maps. Both axes are logarithmic.",
    chart: () => ({
      type: "scatter",
      data: {datasets: seriesOf(sized).map((s) => ({
        ...cloudStyle(s, sized.length), data: sized.filter((run) => run.series === s).map(point)}))},
      options: {scales: {
        x: logAxis("occupied cells", whole, sized.map((run) => run.target_walls + run.source_walls)),
        y: logAxis("", durationTick, sized.map((run) => run.align_s)),
      }},
    }),
  });
}

const iterationCost = (run) => run.propose_s / run.iterations;

function iterationFigure(list) {
  const iterated = list.filter((run) => run.iterations > 1 && known(run.propose_s) && run.source_walls > 0);
  if (iterated.length === 0) {
    return null;
  }
  const point = (run) => ({
    x: run.source_walls, y: 1e3 * iterationCost(run),
    words: [run.series, `${run.set} ${run.pair}`, `${whole(run.source_walls)} cells, ${duration(iterationCost(run))} an iteration`],
  });
  const fits = seriesOf(iterated).map((series) => {
    const own = iterated.filter((run) => run.series === series);
    return {series, own, fit: lineThrough(own.map((run) => ({x: run.source_walls, y: iterationCost(run)})))};
  });
  return chartFigure({
    id: "iteration-cost", title: "Cost of an iteration against cells",
    note: "Each run; occupied cells of the source, which is the map that moves. Lines: least squares.",
    chart: () => ({
      type: "scatter",
      data: {datasets: fits.flatMap(({series, own, fit}) => [
        {...cloudStyle(series, iterated.length), data: own.map(point)},
        {...seriesStyle(series, 0), showLine: true, pointHoverRadius: 0, data: fitEnds(own, fit)},
      ])},
      options: {scales: {
        x: axis("occupied cells of the source", {beginAtZero: true, ticks: {callback: whole, maxTicksLimit: 7}}),
        y: axis("ms an iteration", {beginAtZero: true}),
      }},
    }),
    numbers: fitNumbers(fits),
  });
}

function fitEnds(own, fit) {
  if (!fit) {
    return [];
  }
  const sizes = own.map((run) => run.source_walls);
  const low = sizes.reduce((a, b) => Math.min(a, b)), high = sizes.reduce((a, b) => Math.max(a, b));
  return [low, high].map((x) => ({x, y: 1e3 * (fit.offset + fit.slope * x)}));
}

const fitNumbers = (fits) => ({
  caption: "Least squares: an iteration's time = offset + slope × occupied cells of the source",
  rows: fits.filter(({fit}) => fit),
  columns: [
    {name: "Method", text: true, value: (row) => row.series, cell: (row) => seriesLabel(row.series)},
    {name: "Runs", value: (row) => row.own.length},
    {name: "Slope [µs a cell]", value: (row) => row.fit.slope, cell: (row) => significant(1e6 * row.fit.slope)},
    {name: "Offset", value: (row) => row.fit.offset, cell: (row) => `${significant(1e3 * row.fit.offset)} ms`},
    {name: "R²", value: (row) => row.fit.r2, cell: (row) => digits(row.fit.r2, 3)},
    {name: "Median iteration", value: (row) => spread(row.own.map(iterationCost)).median,
     cell: (row) => duration(spread(row.own.map(iterationCost)).median)},
  ],
});
