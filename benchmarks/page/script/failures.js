// Failures as pictures, and the large view of a run.

let pictures = null;  // read when they are first needed

function picturesOf(place) {
  pictures = pictures ?? JSON.parse(document.getElementById("picture-data").textContent);
  return pictures[place] ?? {};
}

const runByNumber = new Map(runs.map((run) => [run.run, run]));
const failurePlace = new Map(study.failures.map((failure, place) => [failure.run, place]));

function drawFailures(list) {
  const section = document.getElementById("failures");
  if (study.failures.length === 0) {
    section.replaceChildren();
    return;
  }
  const shown = new Set(list.map((run) => run.run));
  const there = study.failures.filter((failure) => shown.has(failure.run));
  const bad = count(list, (run) => isPair(run) && ["wrong", "false", "missed"].includes(run.result));
  section.replaceChildren(
    node("h2", {}, "Failures"),
    node("p", {class: "quiet"}, `${whole(there.length)} of ${plural(bad, "failure", "failures")}: false merges first, then wrong ones, then missed ones, spread over data sets and methods. Open one to see both maps at the pose found and at the true one.`),
    node("div", {class: "gallery"}, there.map((failure) => failureCard(failure, there))),
  );
}

function failureCard(failure, there) {
  const run = runByNumber.get(failure.run);
  const own = picturesOf(failurePlace.get(failure.run));
  const source = own.found || own.truth || own.scene;
  const thumb = source
    ? node("img", {class: "thumb", src: source, alt: "", decoding: "async"})
    : node("span", {class: "thumb"}, "no picture");
  return node("button", {type: "button", "data-run": run.run, onclick: () => openViewer(run, there.map((f) => runByNumber.get(f.run)))}, [
    thumb,
    node("span", {class: "words"}, [
      resultBadge(run.result), node("span", {}, run.series),
      node("span", {class: "quiet"}, `${run.set}: ${run.pair}${run.window && run.window !== "none" ? `, window ${run.window}` : ""}`),
      node("span", {class: "quiet"}, `confidence ${digits(run.confidence, 2)}`),
    ]),
  ]);
}

// The large view of one run of a list; the arrows go through the list.
function openViewer(run, list) {
  const viewer = document.getElementById("viewer");
  showInViewer(viewer, run, list);
  if (!viewer.open) {
    viewer.showModal();
  }
}

function showInViewer(viewer, run, list) {
  const place = list.indexOf(run);
  const go = (step) => list[place + step] && showInViewer(viewer, list[place + step], list);
  const button = (name, label, step) => node("button", {
    type: "button", "aria-label": label, disabled: !list[place + step], "data-step": step, onclick: () => {
      go(step);
      (viewer.querySelector(`[data-step="${step}"]:not(:disabled)`) ?? viewer.querySelector(".close")).focus();
    }}, name);
  viewer.replaceChildren(
    node("div", {class: "viewer-head"}, [
      node("h2", {id: "viewer-title"}, [resultBadge(run.result), ` ${run.series} on ${run.set}: ${run.pair}`]),
      node("span", {class: "quiet"}, list.length > 1 ? `${whole(place + 1)} of ${whole(list.length)}` : ""),
      button("←", "Previous", -1), button("→", "Next", 1),
      node("button", {type: "button", class: "close", onclick: () => viewer.close()}, "Close"),
    ]),
    node("p", {}, [`${run.status || "no status"}, confidence ${digits(run.confidence, 3)}. `, run.reason || "No reason was kept."]),
    node("p", {class: "note"}, errorWords(run)),
    picturesPart(run),
    commandPart(run),
    fieldsPart(run),
  );
  viewer.onkeydown = (event) => {
    const step = {ArrowLeft: -1, ArrowRight: 1}[event.key];
    if (step) {
      event.preventDefault();
      go(step);
      viewer.querySelector(".close").focus();
    }
  };
  viewer.scrollTop = 0;
}

function errorWords(run) {
  if (run.truth === "different") {
    return "The maps share nothing: no pose is right.";
  }
  if (!known(run.error_m)) {
    return "How far the first pose is off the truth is not known.";
  }
  return `The first pose is ${significant(run.error_m)} m and ${significant(run.error_deg)}° off the truth; ` +
    `right is up to ${significant(run.tolerance_m)} m and ${significant(run.tolerance_deg)}°.`;
}

function picturesPart(run) {
  const place = failurePlace.get(run.run);
  if (place === undefined) {
    return node("p", {class: "note"}, "There are no pictures of this run.");
  }
  const own = picturesOf(place);
  const one = (url, title, words) => url ? [node("figure", {}, [
    node("figcaption", {}, [node("h3", {}, title), node("p", {}, words)]), node("img", {src: url, alt: `${title}: ${words}`, decoding: "async"})])] : [];
  const shown = [
    ...one(own.found, "At the pose found", "The source laid on the target where the method put it."),
    ...one(own.truth, "At the true pose", "The same maps, the source where it belongs."),
    ...one(own.scene, "The scene", "The place as it is, and both robots' ways."),
  ];
  const note = study.failures[place].note;
  return node("div", {}, [
    note ? node("p", {class: "note"}, `No pictures: ${note}`) : "",
    node("div", {class: "pictures"}, shown),
  ]);
}

function commandPart(run) {
  const command = commandOf(run);
  if (!command) {
    return "";
  }
  const text = node("pre", {tabindex: "0"}, node("code", {}, command));
  const copy = node("button", {type: "button", class: "copy", onclick: () => copyText(command, copy, text)}, "Copy");
  return node("div", {}, [node("h3", {}, "To run it again"), node("div", {class: "command"}, [text, copy])]);
}

// A file opened from a disk may have no clipboard: then the text is selected, for the keyboard.
async function copyText(text, button, shown) {
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = "Copied";
  } catch {
    getSelection().selectAllChildren(shown);
    button.textContent = "Selected";
  }
}

function fieldsPart(run) {
  const own = Object.keys(study.columns).filter((name) => name !== "reason").map((name) => [name, run[name]]);
  const fields = [...own, ...figuresOf(run)].filter(([, value]) => value !== null && value !== "");
  return node("details", {}, [
    node("summary", {}, "All that is kept of this run"),
    node("dl", {class: "fields"}, fields.map(([name, value]) => node("div", {}, [node("dt", {}, name), node("dd", {}, String(value))]))),
  ]);
}
