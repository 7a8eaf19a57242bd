"use strict";
// The moving mechanism, and the figures that come as data. Lengths in the drawing are millimetres, y up.

const film = JSON.parse(document.getElementById("film").textContent);
const frames = film.time.length;
const value = (name) => film.parameters[name];
const REVOLUTE = ["A", "B", "C"];
const element = (id) => document.getElementById(id);

/// An output at the (broken) frame number `at`, on a straight line between frames.
function output(name, at) {
  const column = film.outputs[name];
  const before = Math.min(Math.floor(at), frames - 1), after = Math.min(before + 1, frames - 1);
  return column[before] + (column[after] - column[before]) * (at - before);
}
const vector = (name, at) => ["x", "y"].map((axis) => output(`${name}.${axis}`, at));

const clearance = (joint) => (value(`joint.${joint}.model`) === 2 ? value(`joint.${joint}.clearance`) : 0);
/// The radius that a joint is drawn with: an ideal one's has no meaning of its own, but a pin needs some.
const radius = (joint) => Math.min(value(`joint.${joint}.radius`), 0.4 * value("crank.length"));

/// How far what is small may be drawn larger: play to a third of the smallest bearing or half the slider's height,
/// deflection to a tenth of the rod's length.
const bent = film.outputs["rod.deflection"].reduce((most, deflection) => Math.max(most, Math.abs(deflection)), 0);
const larger = [
  ...REVOLUTE.filter(clearance).map((joint) => radius(joint) / 3 / clearance(joint)),
  ...(clearance("T") ? [value("slider.height") / 2 / clearance("T")] : []),
  ...(bent ? [value("rod.length") / 10 / bent] : []),
];
const most = larger.length ? Math.max(1, Math.min(...larger)) : 1;

/// Where everything is [m], of a mechanism whose play, tilt and deflection are `k` times as large.
function pose(at, k) {
  const [eA, eB, eC] = REVOLUTE.map((joint) => vector(`joint.${joint}.eccentricity`, at).map((e) => e * k));
  const angle = output("crank.angle", at);
  const pin = [eA[0] + value("crank.length") * Math.cos(angle), eA[1] + value("crank.length") * Math.sin(angle)];
  const bigEnd = [pin[0] - eB[0], pin[1] - eB[1]];
  const resting = value("guide.offset") - value("slider.centre.y");
  const tilt = output("slider.angle", at) * k;
  const length = value("rod.length") + output("rod.stretch", at) * k;
  const y = resting + (output("slider.y", at) - resting) * k;
  // The loop closes: the rod reaches from the crank pin to the height of the slider's pin.
  const rise = Math.max(-1, Math.min(1, (y - eC[1] - bigEnd[1]) / length));
  const forwards = Math.sign(Math.cos(output("rod.angle", at))) || 1;
  const run = forwards * Math.sqrt(1 - rise * rise);
  const smallEnd = [bigEnd[0] + length * run, bigEnd[1] + length * rise];
  const slider = [smallEnd[0] + eC[0], y];
  const deflection = output("rod.deflection", at) * k;
  return { angle, main: eA, pin, bigEnd, smallEnd, slider, tilt, rod: [run, rise], deflection };
}

// Drawing

const SVG = "http://www.w3.org/2000/svg";
const mm = (metres) => metres * 1e3;
function draw(parent, kind, attributes, looks = "") {
  const shape = document.createElementNS(SVG, kind);
  for (const [name, text] of Object.entries(attributes)) shape.setAttribute(name, text);
  shape.setAttribute("vector-effect", "non-scaling-stroke");
  if (looks) shape.setAttribute("style", looks);
  parent.append(shape);
  return shape;
}
const STEEL = "fill:#c9d2dd;stroke:#3c4859;stroke-width:1.5";
const CRANK = "fill:#66758a;stroke:#2a3442;stroke-width:1.5";
const ROD = "fill:none;stroke:#1c5390;stroke-linecap:round";
const RED = "#c43e3e";

const drawing = element("drawing");
const [r, l] = [value("crank.length"), value("rod.length")];
const [half, height] = [value("slider.length") / 2, value("slider.height")];
const [centreX, centreY] = [value("slider.centre.x"), value("slider.centre.y")];
const room = 0.25 * r + Math.max(radius("A"), radius("B"));
const left = -r - room, right = r + l + half + Math.abs(centreX) + room;
const up = Math.max(r, Math.abs(value("guide.offset")) + height) + room;
drawing.setAttribute("viewBox", [mm(left), mm(-up), mm(right - left), mm(2 * up)].join(" "));
const world = draw(drawing, "g", { transform: "scale(1,-1)" });
draw(world, "circle", { cx: 0, cy: 0, r: mm(r) }, "fill:none;stroke:#b6c3d2;stroke-width:1;stroke-dasharray:5 5");
const guides = [1, -1].map(() => draw(world, "line", { id: "guide" }, "stroke:#3c4859;stroke-width:2"));
draw(world, "circle", { cx: 0, cy: 0, r: mm(radius("A")) }, "fill:#e8ecf1;stroke:#3c4859;stroke-width:2");
const slider = draw(world, "g", { id: "slider" });
draw(slider, "rect", { x: mm(centreX - half), y: mm(centreY - height / 2), width: mm(2 * half), height: mm(height), rx: mm(0.04 * height) }, STEEL);
const rod = draw(world, "path", { id: "rod" }, `${ROD};stroke-width:9;opacity:0.85`);
const bearings = ["B", "C"].map((joint) => draw(world, "circle", { r: mm(radius(joint)) }, "fill:#fdf3e1;stroke:#1c5390;stroke-width:3"));
const crank = draw(world, "line", { id: "crank" }, "stroke:#4a586b;stroke-width:9;stroke-linecap:round");
const journals = REVOLUTE.map((joint) => draw(world, "circle", { id: `journal${joint}` }, joint === "C" ? STEEL : CRANK));
const arrows = ["A", "B", "C", "T"].map((joint) => draw(world, "path", { id: `arrow${joint}` }, `fill:none;stroke:${RED};stroke-width:2.5;stroke-linejoin:round`));

// Which way is down, in the upper corner on the right.
if (value("gravity")) {
  const size = 0.35 * r * Math.sign(value("gravity")), angle = value("gravity.angle");
  const [x, y] = [size * Math.cos(angle), size * Math.sin(angle)];
  const [fromX, fromY] = [right - 0.6 * r - x / 2, up - 0.3 * r - y / 2];
  const barb = (side) => [fromX + 0.7 * x - side * 0.2 * y, fromY + 0.7 * y + side * 0.2 * x].map(mm).join(" ");
  const tip = [fromX + x, fromY + y].map(mm).join(" ");
  const path = `M${[fromX, fromY].map(mm).join(" ")}L${tip}M${barb(1)}L${tip}L${barb(-1)}`;
  draw(world, "path", { id: "gravity", d: path }, "fill:none;stroke:#5d6878;stroke-width:2.5;stroke-linejoin:round");
  const label = { x: mm(fromX + 0.5 * x + 0.18 * r), y: -mm(fromY + 0.5 * y - 0.05 * r), "font-size": mm(0.2 * r), fill: "#5d6878" };
  draw(drawing, "text", label).textContent = "g";
}

/// A close look at each journal with play: the circle is what is free to its centre.
const looks = REVOLUTE.filter(clearance).map((joint) => {
  const svg = document.createElementNS(SVG, "svg");
  svg.setAttribute("viewBox", "-1.5 -1.5 3 3.3");
  element("bearings").append(svg);
  const turned = draw(svg, "g", { transform: "scale(1,-1)" });
  draw(turned, "circle", { r: 1 }, "fill:white;stroke:#1c5390;stroke-width:2");
  const trail = draw(turned, "path", {}, "fill:none;stroke:#9fb6cf;stroke-width:1.2");
  const dot = draw(turned, "circle", { id: `dot${joint}`, r: 0.09 }, `fill:${RED}`);
  const text = draw(svg, "text", { x: 0, y: 1.55, "text-anchor": "middle", "font-size": 0.27, fill: "#5d6878" });
  text.textContent = `${joint}: ${Number((clearance(joint) * 1e6).toPrecision(3))} µm`;
  return { joint, dot, trail };
});

// Forces: nineteen in twenty have arrows shorter than half of this length.
const reach = Math.max(r, 0.2 * l);
const force = (joint, at) => vector(`joint.${joint}.force`, at);
const sizes = ["A", "B", "C", "T"].flatMap((joint) =>
  Array.from({ length: frames }, (_, at) => Math.hypot(...force(joint, at)))).sort((a, b) => a - b);
const usual = sizes[Math.floor(0.95 * (sizes.length - 1))] || 1;
const LONGEST = 1.6;

const point = ([x, y]) => `${mm(x)} ${mm(y)}`;
function arrow(shape, [x, y], [fx, fy], scale) {
  const size = Math.hypot(fx, fy);
  const length = Math.min(0.5 * reach * scale * size / usual, LONGEST * reach);
  if (!(length > 0.02 * reach)) return shape.setAttribute("d", "");
  const [ux, uy] = [fx / size, fy / size], head = Math.min(0.12 * reach, 0.4 * length);
  const tip = [x + length * ux, y + length * uy];
  const barb = (side) => [tip[0] - head * ux - side * 0.5 * head * uy, tip[1] - head * uy + side * 0.5 * head * ux];
  shape.setAttribute("d", `M${point([x, y])}L${point(tip)}M${point(barb(1))}L${point(tip)}L${point(barb(-1))}`);
}

const state = { at: 0, k: 1, scale: 1, playing: false, slow: 1 };
const TRAIL = 60;

function show() {
  const { at, k, scale } = state;
  const here = pose(at, k);
  const joints = { A: here.main, B: here.pin, C: here.slider };
  crank.setAttribute("x1", mm(here.main[0])); crank.setAttribute("y1", mm(here.main[1]));
  crank.setAttribute("x2", mm(here.pin[0])); crank.setAttribute("y2", mm(here.pin[1]));
  const across = [-here.rod[1], here.rod[0]];
  // A parabola's control point is twice as far out as its middle.
  const bend = [0, 1].map((i) => (here.bigEnd[i] + here.smallEnd[i]) / 2 + 2 * here.deflection * across[i]);
  rod.setAttribute("d", `M${point(here.bigEnd)}Q${point(bend)} ${point(here.smallEnd)}`);
  [here.bigEnd, here.smallEnd].forEach(([x, y], i) => { bearings[i].setAttribute("cx", mm(x)); bearings[i].setAttribute("cy", mm(y)); });
  REVOLUTE.forEach((joint, i) => {
    const [x, y] = joints[joint];
    journals[i].setAttribute("cx", mm(x)); journals[i].setAttribute("cy", mm(y));
    journals[i].setAttribute("r", mm(Math.max(0.85 * radius(joint) - (k * clearance(joint)), 0.3 * radius(joint))));
  });
  slider.setAttribute("transform", `translate(${point(here.slider)}) rotate(${here.tilt * 180 / Math.PI})`);
  guides.forEach((line, i) => {
    const y = value("guide.offset") + (i ? -1 : 1) * (height / 2 + k * clearance("T"));
    line.setAttribute("x1", mm(Math.max(l - r - half, radius("A") * 1.5))); line.setAttribute("x2", mm(right));
    line.setAttribute("y1", mm(y)); line.setAttribute("y2", mm(y));
  });
  const centre = [here.slider[0] + centreX, here.slider[1] + centreY];
  [["A", here.main], ["B", here.bigEnd], ["C", here.slider], ["T", centre]].forEach(([joint, place], i) =>
    arrow(arrows[i], place, force(joint, at), scale));
  for (const { joint, dot, trail } of looks) {
    const place = (frame) => vector(`joint.${joint}.eccentricity`, frame).map((e) => e / clearance(joint));
    const [x, y] = place(at);
    dot.setAttribute("cx", x); dot.setAttribute("cy", y);
    const first = Math.max(0, Math.floor(at) - TRAIL);
    const path = Array.from({ length: Math.floor(at) - first + 1 }, (_, i) => place(first + i).join(" "));
    trail.setAttribute("d", `M${path.join("L")}`);
  }
  const degrees = ((output("crank.angle", at) * 180 / Math.PI) % 360 + 360) % 360;
  element("where").value = `${turns(at).toFixed(3)} turns, ${degrees.toFixed(1)}°, x ${mm(output("slider.x", at)).toFixed(3)} mm`;
  element("scrub").value = at / (frames - 1 || 1);
  element("exaggerated").value = `× ${k.toPrecision(3)}`;
  element("slowed").value = `${Number(state.slow.toPrecision(2))} times`;
  element("forced").value = `${Number((usual / scale / 1e3).toPrecision(2))} kN = ${Number(mm(reach / 2).toPrecision(2))} mm`;
}
function turns(at) {
  const before = Math.min(Math.floor(at), frames - 1), after = Math.min(before + 1, frames - 1);
  return film.turns[before] + (film.turns[after] - film.turns[before]) * (at - before);
}

// Controls

const duration = film.time[frames - 1] - film.time[0];
element("slow").min = 0; element("slow").max = Math.max(1, Math.log10(60 / duration));
// At first, a film of ten seconds.
element("slow").value = Math.max(0, Math.log10(10 / duration));
const read = () => {
  state.slow = 10 ** Number(element("slow").value);
  state.k = most ** Number(element("exaggeration").value);
  state.scale = 10 ** Number(element("force").value);
};
for (const id of ["slow", "exaggeration", "force"]) element(id).addEventListener("input", () => { read(); show(); });
element("scrub").addEventListener("input", (event) => { state.at = event.target.value * (frames - 1); show(); });

let last = 0;
function tick(now) {
  if (!state.playing) return;
  const perSecond = (frames - 1) / duration / state.slow;
  state.at = (state.at + Math.min(now - last, 100) / 1e3 * perSecond) % (frames - 1 || 1);
  last = now;
  show();
  requestAnimationFrame(tick);
}
element("play").addEventListener("click", () => {
  state.playing = !state.playing;
  element("play").textContent = state.playing ? "Pause" : "Play";
  element("play").setAttribute("aria-pressed", state.playing);
  if (state.playing) { last = performance.now(); requestAnimationFrame(tick); }
});
element("exaggeration").disabled = most === 1;
read();
show();

// Figures

// On a phone a finger on a figure scrolls the page; the bar above the figure zooms.
const coarse = matchMedia("(pointer: coarse)").matches;
const overTurns = [];
for (const figure of document.querySelectorAll("figure.plot")) {
  const { data, layout } = JSON.parse(figure.querySelector("script").textContent);
  Object.assign(layout, { dragmode: coarse ? false : "zoom", font: { family: "system-ui, sans-serif", size: 12, color: "#262c36" } });
  for (const axis of [layout.xaxis, layout.yaxis]) axis.title.font = { size: 12 };
  if (layout.showlegend) layout.legend = { orientation: "h", y: -0.2, yanchor: "top" };
  Plotly.newPlot(figure, data, layout, { responsive: true, displaylogo: false, displayModeBar: coarse ? true : "hover" });
  if (figure.dataset.over === "turns" && film.turns.length) overTurns.push(figure);
}
// What is over turns zooms together, and a click goes there.
let following = false;
for (const figure of overTurns) {
  figure.on("plotly_relayout", (change) => {
    if (following) return;
    const range = ["xaxis.range[0]", "xaxis.range[1]", "xaxis.autorange"].filter((key) => key in change);
    if (!range.length) return;
    following = true;
    const same = Object.fromEntries(range.map((key) => [key, change[key]]));
    const others = overTurns.filter((other) => other !== figure).map((other) => Plotly.relayout(other, same));
    Promise.all(others).finally(() => { following = false; });
  });
  figure.on("plotly_click", ({ points }) => {
    const turn = points[0].x, after = film.turns.findIndex((own) => own >= turn);
    if (after >= 0) { state.at = after; show(); }
  });
}
