// Success and time by the number of robots, where there are more than two.

function drawRobots(list) {
  const section = document.getElementById("robots");
  if (!list.some((run) => run.robots > 2)) {
    section.replaceChildren();
    return;
  }
  const groups = [...groupBy(list, (run) => JSON.stringify([run.robots, run.series])).values()];
  const rows = groups.map((of) => {
    const judged = of.filter((run) => ["right", "wrong", "missed"].includes(run.result));
    const placed = of.reduce((sum, run) => sum + run.robots_right, 0);
    const elsewhere = of.reduce((sum, run) => sum + run.robots_wrong, 0);
    const robots = of.reduce((sum, run) => sum + run.robots, 0);
    return {
      robots: of[0].robots, series: of[0].series, n: of.length,
      right: wilson(count(judged, (run) => run.result === "right"), judged.length),
      placed: robots ? placed / robots : null, elsewhere: robots ? elsewhere / robots : null,
      time: spread(of.map((run) => run.align_s)),
    };
  }).sort((a, b) => a.robots - b.robots || seriesPlace.get(a.series) - seriesPlace.get(b.series));
  const series = seriesOf(list.filter((run) => run.robots > 2));
  section.replaceChildren(
    node("h2", {}, "Many robots"),
    node("p", {class: "quiet"}, "All maps of a run merged into one. A run is right if every robot is placed where it belongs."),
    legend(series),
    node("div", {class: "charts"}, robotFigures(rows, series)),
    robotsTable(rows.filter((row) => row.robots > 2 || series.includes(row.series))),
  );
}

function robotFigures(rows, series) {
  const names = distinct(rows, (row) => row.robots).map(String);
  const find = (s, name) => rows.find((row) => row.series === s && String(row.robots) === name) ?? null;
  const right = (s, name) => {
    const row = find(s, name);
    return row && known(row.right.share) ? sharePoint({series: s, step: `${name} robots`, share: row.right}, "y") : null;
  };
  const placed = (s, name) => {
    const row = find(s, name);
    return row && row.robots > 2 && {
      y: 100 * row.placed, words: [`${s}, ${name} robots`, `${percent(row.placed)} of the robots placed rightly`]};
  };
  const time = (s, name) => {
    const row = find(s, name);
    return row && known(row.time.median) ? {
      y: row.time.median, low: row.time.lower, high: row.time.upper,
      words: [`${s}, ${name} robots`, `median ${duration(row.time.median)}`, `quartiles ${duration(row.time.lower)}, ${duration(row.time.upper)}`],
    } : null;
  };
  const orNull = (point) => (s, name) => point(s, name) || null;
  return [
    chartFigure({id: "robots-success", title: "Right by number of robots", note: "Lines across: Wilson's 95 % interval.",
      chart: () => stepsChart({names, series, point: right, xTitle: "robots", yAxis: percentAxis("right")})}),
    chartFigure({id: "robots-time", title: "Time by number of robots", note: "All runs: median and quartiles. Logarithmic.",
      chart: () => stepsChart({names, series, point: time, xTitle: "robots", yAxis: logAxis("", durationTick, rows.flatMap((row) => [row.time.lower, row.time.upper]))})}),
    chartFigure({id: "robots-placed", title: "Robots placed rightly", note: "Of all robots of all runs; the first of a run always counts.",
      chart: () => stepsChart({names, series, point: orNull(placed), xTitle: "robots", yAxis: percentAxis("of robots")})}),
  ];
}

function robotsTable(rows) {
  return table({
    id: "robots-table",
    caption: "By number of robots. In brackets: Wilson's 95 % interval.",
    rows,
    columns: [
      {name: "Robots", value: (row) => row.robots},
      {name: "Method", text: true, value: (row) => row.series, cell: (row) => seriesLabel(row.series)},
      {name: "Runs", value: (row) => row.n, cell: (row) => whole(row.n)},
      {name: "Right", value: (row) => row.right.share, cell: (row) => shareCell(row.right)},
      {name: "Robots placed rightly", value: (row) => row.robots > 2 ? row.placed : null, cell: (row) => row.robots > 2 ? percent(row.placed) : kNone},
      {name: "Placed elsewhere", value: (row) => row.robots > 2 ? row.elsewhere : null, cell: (row) => row.robots > 2 ? percent(row.elsewhere) : kNone},
      {name: "Median time", value: (row) => row.time.median, cell: (row) => duration(row.time.median)},
      {name: "Slowest", value: (row) => row.time.worst, cell: (row) => duration(row.time.worst)},
    ],
  });
}
