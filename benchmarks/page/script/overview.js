// What was run, with what, and how each method did.

function drawAbout() {
  const about = document.getElementById("about");
  about.textContent = study.about;
  about.hidden = !study.about;
}

function drawOverview(list) {
  const section = document.getElementById("overview");
  section.replaceChildren(facts(list));
  const pairs = list.some(isPair) ? list.filter(isPair) : list;
  if (list.length === 0) {
    section.append(node("p", {class: "empty"}, runs.length === 0 ? "This study has no runs yet." : "The filter leaves no run."));
    return;
  }
  section.append(methodsTable(pairs), node("p", {class: "note"}, overviewNote(pairs, list)));
}

function listed(values, most = 4) {
  const there = values.filter((value) => value !== "" && value !== null);
  const more = there.length > most ? ` and ${there.length - most} more` : "";
  return there.slice(0, most).join(", ") + more || kNone;
}

function facts(list) {
  const of = (key) => listed(distinct(list, (run) => run[key]));
  const builds = distinct(list, (run) => [run.version, run.commit && `commit ${run.commit}`, run.compiler].filter(Boolean).join(", "));
  const seconds = list.reduce((sum, run) => sum + (known(run.align_s) ? run.align_s : 0), 0);
  const pairs = distinct(list, (run) => `${run.set}\n${run.pair}`).length;
  const entries = [
    ["Runs", `${plural(list.length, "run", "runs")} of ${plural(distinct(list, (run) => run.series).length, "method", "methods")} on ` +
      `${plural(pairs, "pair", "pairs")} from ${plural(distinct(list, (run) => run.set).length, "data set", "data sets")}`],
    ["Date", dates(list)],
    ["Machine", `${of("cpu")}; threads a run: ${of("threads")}`],
    ["Version", listed(builds)],
    ["Time", `${duration(seconds)} of aligning`],
  ];
  return node("dl", {class: "facts"}, entries.flatMap(([name, value]) => [node("dt", {}, name), node("dd", {}, value)]));
}

function dates(list) {
  const all = list.map((run) => run.date).filter(Boolean).sort();
  const words = (date) => date.replace("T", " ").replace("Z", " UTC");
  if (all.length === 0) {
    return kNone;
  }
  return all[0] === all[all.length - 1] ? words(all[0]) : `${words(all[0])} to ${words(all[all.length - 1])}`;
}

function methodsTable(list) {
  const rows = [...groupBy(list, (run) => run.series)].map(([series, of]) => ({
    series, ...outcomes(of),
    time: spread(of.filter((run) => run.result === "right").map((run) => run.align_s)),
  }));
  rows.sort((a, b) => seriesPlace.get(a.series) - seriesPlace.get(b.series));
  const share = (name, key, title) => ({name, title, value: (row) => row[key].share, cell: (row) => shareCell(row[key])});
  return table({
    id: "methods-table",
    caption: "Methods. In brackets: Wilson's 95 % interval.",
    rows,
    columns: [
      {name: "Method", text: true, value: (row) => row.series, cell: (row) => seriesLabel(row.series)},
      {name: "Runs", value: (row) => row.runs, cell: (row) => whole(row.runs)},
      {name: "", value: (row) => row.rightShare.share,
       cell: (row) => gauge(row.rightShare, `var(--series-${seriesPlace.get(row.series) % kColours})`)},
      share("Right", "rightShare", "Of pairs that share something: merged, and where it belongs"),
      share("Wrong", "wrongShare", "Of pairs that share something: merged, but elsewhere"),
      share("Missed", "missedShare", "Of pairs that share something: not merged"),
      share("False", "falseShare", "Of pairs that share nothing: merged all the same"),
      {name: "Median time", title: "Of the right runs", value: (row) => row.time.median, cell: (row) => duration(row.time.median)},
    ],
  });
}

function overviewNote(pairs, list) {
  const all = outcomes(pairs);
  const parts = [`Right, wrong and missed: of the ${plural(all.same, "run", "runs")} on maps that share something. ` +
                 `False: of the ${plural(all.different, "run", "runs")} on maps that share nothing. Time: of the right runs.`];
  if (all.unknown > 0) {
    parts.push(`${plural(all.unknown, "run has", "runs have")} no known truth and count nowhere.`);
  }
  if (pairs.length < list.length) {
    parts.push(`${plural(list.length - pairs.length, "run", "runs")} of more than two robots: see Many robots.`);
  }
  return parts.join(" ");
}
