// The study as the program wrote it, and one object a run.

const study = JSON.parse(document.getElementById("study-data").textContent);
const runs = decodeRuns();
const figureNames = study.figures.map((figure) => figure.name);

// A column is a list of numbers (null: not known), or {words, at}: each text once, and which one each run has.
function cells(column) {
  return Array.isArray(column) ? column : column.at.map((word) => column.words[word]);
}

function decodeRuns() {
  const names = Object.keys(study.columns);
  const columns = names.map((name) => cells(study.columns[name]));
  const decoded = new Array(study.count);
  for (let i = 0; i < study.count; ++i) {
    const run = {index: i};
    for (let k = 0; k < names.length; ++k) {
      run[names[k]] = columns[k][i];
    }
    run.series = seriesName(run);
    decoded[i] = run;
  }
  return decoded;
}

// What is compared: a method with its profile, and what was changed in it.
function seriesName(run) {
  const name = run.profile ? `${run.method} (${run.profile})` : run.method;
  return (run.options ? `${name} ${run.options}` : name) || "unnamed";
}

function commandOf(run) {
  return study.commands ? study.commands.words[study.commands.at[run.index]] : "";
}

function figuresOf(run) {
  return study.figures.map((figure) => [figure.name, figure.values[run.index]]);
}

// Distinct values in the order of their first appearance.
function distinct(list, valueOf) {
  return [...new Set(list.map(valueOf))];
}

// A Map from a key to the list of those that have it, in the order of first appearance.
function groupBy(list, keyOf) {
  const groups = new Map();
  for (const item of list) {
    const key = keyOf(item);
    const group = groups.get(key);
    if (group) {
      group.push(item);
    } else {
      groups.set(key, [item]);
    }
  }
  return groups;
}

const known = (value) => value !== null && Number.isFinite(value);
const isPair = (run) => run.robots <= 2;

// Windows from the narrowest to the widest; "none" is anywhere.
function windowSize(run) {
  return run.window === "none" || !known(run.window_m) ? Infinity : run.window_m;
}
function windowsInOrder(list) {
  const sizes = new Map();
  for (const run of list) {
    if (!sizes.has(run.window)) {
      sizes.set(run.window, windowSize(run));
    }
  }
  return [...sizes.keys()].sort((a, b) => (sizes.get(a) === sizes.get(b) ? 0 : sizes.get(a) - sizes.get(b)));
}
