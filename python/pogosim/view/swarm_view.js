// The view of a run: what is drawn when, and what mouse, keys and controls do.

const TAIL_S = 5;

// Shows a run in the elements of view.html.
//
// root: the document, or a shadow root, that has these elements.
// run: what is shown, a RecordedRun or a LiveRun: head, space, colours, times, track, dots, columns, bodyLinks,
//     lightAt(index), wallColour(wall, index); version, which grows with each record that comes; moreValues(object);
//     start: how it begins: speed, tail_s, and view, the section of that name of a configuration.
// player: what moves time: isPlaying, toggle(), step(records), setSpeed(speed), speeds, seek(time), tick(now);
//     optional: drag(object, x, y), select(object), showColumns(names), keys.
function swarmView(root, run, player) {
const {head} = run;
const count = head.objects.length;
const element = (id) => root.getElementById(id);
const canvas = element("arena");
const poses = Array.from({length: count}, () => ({x: NaN, y: NaN, angle: NaN}));
const state = {
    time: run.times[0], index: 0, selected: -1, hovered: -1, followed: -1, tail_s: run.start.tail_s ?? TAIL_S,
    frames: 0, ratio: 0,
    shows: {},  // what is switched on, by the names of the switches
    colouring: run.columns[0], heat: "", heatColumn: null,
};
const camera = new Camera(canvas, run.space);
const painter = makePainter({run, canvas, camera, poses, state});
const {categoryOf, colourOf} = painter;
const ended = new AbortController();  // of all that listens
const switches = new Switches(root, state.shows, listen, (name) => {
    if (name === "theme" || name === "palette") {
        run.colours.choose(state.shows.theme, state.shows.palette);
        showKey();
    }
    element("clock").hidden = !state.shows.time;
    dirty = true;
});
let dirty = true, heatKey = null;

function redraw() {
    dirty = true;
}

function setTime(time) {
    state.time = Math.min(Math.max(time, run.times[0]), run.times[run.times.length - 1]);
    state.index = run.track.indexAt(state.time);
    const share = run.track.shareAt(state.time, state.index);
    for (let object = 0; object < count; object++) run.track.at(object, state.index, share, poses[object]);
    dirty = true;
}

function showPlaying() {
    element("play").classList.toggle("playing", player.isPlaying);
    element("play").setAttribute("aria-label", player.isPlaying ? "Pause" : "Play");
}

function setSpeed(speed) {
    player.setSpeed(speed);
    element("speed").value = String(speed);
}

function colourBy(name) {
    const found = run.columns.find((column) => column.name === name);
    if (!found) throw new Error(`no column ${name}`);
    state.colouring = found;
    element("colour").value = name;
    showColumns();
}

// name: "", DENSITY, or that of a column of numbers.
function heatBy(name) {
    state.heatColumn = run.columns.find((column) => column.name === name && column.shades) ?? null;
    state.heat = name === DENSITY || state.heatColumn ? name : "";
    element("heat").value = state.heat;
    showColumns();
}

function showColumns() {
    player.showColumns?.([state.colouring.name, state.heat]);
    showKey();
    dirty = true;
}

function select(object) {
    state.selected = object;
    if (state.followed >= 0) follow(object);
    player.select?.(object);
    dirty = true;
}

// Keeps an object in the middle; -1: none.
function follow(object) {
    state.followed = object;
    element("follow").checked = object >= 0;
    dirty = true;
}

const followSelected = (on) => follow(on ? state.selected : -1);

function fit() {
    camera.fit();
    follow(-1);
}

function resize() {
    state.ratio = window.devicePixelRatio || 1;
    canvas.width = Math.max(Math.round(canvas.clientWidth * state.ratio), 1);
    canvas.height = Math.max(Math.round(canvas.clientHeight * state.ratio), 1);
    if (camera.fitted || !camera.hasSize) camera.fit(camera.zoomAtFit);
    dirty = true;
}

// The object at a place on the screen, -1 if there is none; with a few pixels to spare.
function objectAt(px, py, slack) {
    const [x, y] = camera.toArena(px, py);
    let nearest = -1, least = Infinity;
    for (let object = 0; object < count; object++) {
        const [dx, dy] = run.space.nearestImage(x - poses[object].x, y - poses[object].y);
        const distance = Math.hypot(dx, dy);
        const radius = categoryOf(object).membrane ? 8 / camera.scale : categoryOf(object).radius + slack / camera.scale;
        if (distance <= radius && distance < least) [nearest, least] = [object, distance];
    }
    return nearest;
}

function draw() {
    if (state.followed >= 0) {
        const {x, y} = poses[state.followed];
        if (x === x) camera.moveTo(x, y);
    }
    const heat = painter.draw();
    if (heat?.to !== heatKey?.to || heat?.from !== heatKey?.from || heat?.name !== heatKey?.name) {
        heatKey = heat;
        showKey();
    }
    element("clock").textContent = `${state.time.toFixed(2)} s`;
    const scrub = element("scrub");
    [scrub.min, scrub.max] = [String(run.times[0]), String(run.times[run.times.length - 1])];
    scrub.value = String(state.time);
    scrub.setAttribute("aria-valuetext", `${state.time.toFixed(2)} seconds`);
    showRobot();
    state.frames++;
}

function tick(now) {
    if (ended.signal.aborted) return;
    player.tick(now);
    if (state.ratio !== (window.devicePixelRatio || 1)) resize();  // it is on another screen now
    if (dirty) {
        dirty = false;
        draw();
    }
    requestAnimationFrame(tick);
}

// ---- panels

const rounded = (value) => typeof value === "number" ? String(Number(value.toPrecision(6))) : String(value);

// Values of all columns of an object, in the order of the file.
function valuesOf(object) {
    const values = {category: categoryOf(object).name, id: head.objects[object][1]};
    const {x, y, angle} = poses[object];
    for (const [name, value] of [["x", x], ["y", y], ["angle", angle]]) {
        if (value === value) values[name] = Number(value.toFixed(name === "angle" ? 4 : 2));
    }
    for (const column of run.columns) {
        if (!column.isListed) continue;
        const name = column.name in values ? `${column.name} (column)` : column.name;
        values[name] = column.value(object, state.index);
    }
    return {...values, ...run.moreValues?.(object)};
}

function tableOf(values) {
    const table = document.createElement("table");
    for (const [name, value] of Object.entries(values)) {
        const row = table.insertRow();
        row.insertCell().textContent = name;
        row.insertCell().textContent = value === null ? "–" : rounded(value);
    }
    return table;
}

const nameOf = (object) => `${categoryOf(object).name} ${head.objects[object][1] ?? ""}`.trim();

function showRobot() {
    const panel = element("robot");
    panel.hidden = state.selected < 0;
    if (!panel.hidden) panel.replaceChildren(heading(nameOf(state.selected)), tableOf(valuesOf(state.selected)));
    const tip = element("hover");
    tip.hidden = state.hovered < 0;
    if (tip.hidden) return;
    tip.replaceChildren(heading(nameOf(state.hovered)), tableOf(valuesOf(state.hovered)));
    const [x, y] = camera.toScreen(poses[state.hovered].x, poses[state.hovered].y);
    tip.style.left = `${Math.max(4, Math.min(x + 18, canvas.clientWidth - tip.offsetWidth - 8))}px`;
    tip.style.top = `${Math.max(4, Math.min(y + 14, canvas.clientHeight - tip.offsetHeight - 8))}px`;
}

function heading(text) {
    const own = document.createElement("h2");
    own.textContent = text;
    return own;
}

const UNITS = new Map([["speed", "mm/s"], ["x", "mm"], ["y", "mm"], ["angle", "rad"]]);  // as in src/sim/robot_values.cpp
const titleOf = (name) => UNITS.has(name) ? `${name} (${UNITS.get(name)})` : name;

// What the colours mean: a bar for numbers, a list for names, nothing for LEDs.
function showKey() {
    const key = element("key");
    const isOfRobots = !state.colouring.led, heat = state.heat ? heatKey : null;
    key.hidden = !isOfRobots && !heat;
    key.replaceChildren();
    if (isOfRobots) showColouring(key);
    if (heat) key.append(heading(titleOf(heat.name)), ...barOf(heat));
}

function showColouring(key) {
    key.append(heading(titleOf(state.colouring.name)));
    if (state.colouring.labels && !state.colouring.base) {
        state.colouring.labels.slice(0, 40).forEach((label, i) => key.append(entry(label, state.colouring.colours[i])));
        if (state.colouring.labels.length > 40) key.append(`and ${state.colouring.labels.length - 40} more`);
    } else if (state.colouring.base) {
        head.categories.forEach((own, category) => {
            if (head.categories.findIndex(({name}) => name === own.name) !== category) return;  // one of several kinds
            const object = head.objects.findIndex(([number]) => number === category);
            key.append(entry(own.name, state.colouring.colour(object, run.times.length - 1)));
        });
    } else {
        key.append(...barOf(state.colouring));
    }
}

// What stands below both ends of a bar of colours, as in src/render/key_layer.cpp.
function endsOf({from, to, shades}) {
    if (shades === "angle") return ["-pi", "pi"];
    return from <= to ? [from, to].map((value) => String(Number(value.toPrecision(4)))) : ["no values", ""];
}

function barOf(scale) {
    const bar = document.createElement("div");
    bar.className = "bar";
    bar.style.background = `linear-gradient(to right, ${run.colours.shades[scale.shades].filter((_, i) => i % 15 === 0).join(", ")})`;
    const ends = document.createElement("div");
    ends.className = "ends";
    ends.append(...endsOf(scale).map((text) => Object.assign(document.createElement("span"), {textContent: text})));
    return [bar, ends];
}

function entry(label, colour) {
    const line = document.createElement("div");
    const swatch = document.createElement("span");
    swatch.className = "swatch";
    swatch.style.background = colour;
    line.append(swatch, label);
    return line;
}

// ---- controls

function toggleViewPanel() {
    const panel = element("view_panel");
    panel.hidden = !panel.hidden;
    element("view_button").setAttribute("aria-expanded", String(!panel.hidden));
}

function toggleHelp(show = element("help").hidden) {
    element("help").hidden = !show;
}

const KEYS = {
    " ": () => player.toggle(),
    ArrowLeft: (event) => player.step(event.shiftKey ? -10 : -1),
    ArrowRight: (event) => player.step(event.shiftKey ? 10 : 1),
    Home: () => player.seek(run.times[0]),
    End: () => player.seek(run.times[run.times.length - 1]),
    "+": () => setSpeed(nextSpeed(1)),
    "=": () => setSpeed(nextSpeed(1)),
    "-": () => setSpeed(nextSpeed(-1)),
    ...switches.keys(),
    d: () => heatBy(state.heat ? "" : DENSITY),
    f: () => followSelected(state.followed < 0),
    0: fit,
    F9: () => toggleViewPanel(),
    "?": () => toggleHelp(),
    Escape: () => { toggleHelp(false); select(-1); follow(-1); },
    ...player.keys,
};

function nextSpeed(direction) {
    const known = [...element("speed").options].map((option) => Number(option.value));
    const place = known.indexOf(Number(element("speed").value)) + direction;
    return known[Math.min(Math.max(place, 0), known.length - 1)];
}

function listen(target, type, heard, options = {}) {
    target.addEventListener(type, heard, {...options, signal: ended.signal});
}

function listenToKeys() {
    listen(root, "keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        const own = event.target;
        const isText = own.tagName === "SELECT" || (own.tagName === "INPUT" && ["text", "number"].includes(own.type));
        if (isText || (own.type === "checkbox" && event.key === " ")) return;
        const action = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
        if (!action) return;
        event.preventDefault();
        event.stopPropagation();  // of a notebook, which has keys of its own
        action(event);
    });
    // A space that has been taken as play must not also press the button that has the focus.
    listen(root, "keyup", (event) => {
        if (event.key === " " && event.target.tagName === "BUTTON") event.preventDefault();
    });
}

function listenToControls() {
    listen(element("play"), "click", () => player.toggle());
    listen(element("scrub"), "input", (event) => player.seek(Number(event.target.value)));
    listen(element("speed"), "change", (event) => setSpeed(Number(event.target.value)));
    listen(element("colour"), "change", (event) => colourBy(event.target.value));
    listen(element("heat"), "change", (event) => heatBy(event.target.value));
    listen(element("follow"), "change", (event) => followSelected(event.target.checked));
    listen(element("view_button"), "click", toggleViewPanel);
    listen(element("fit"), "click", fit);
    listen(element("help_button"), "click", () => toggleHelp());
    const resized = new ResizeObserver(resize);
    resized.observe(canvas);
    ended.signal.addEventListener("abort", () => resized.disconnect());
}

// ---- start

function fillControls() {
    element("title").textContent = head.title;
    element("notes").textContent = head.notes;
    const speeds = [...new Set([...player.speeds, run.start.speed])].sort((a, b) => a - b);
    const label = (speed) => speed === Infinity ? "fastest" : `${Number(speed.toPrecision(3))} ×`;
    element("speed").replaceChildren(...speeds.map((speed) => new Option(label(speed), String(speed))));
    fillColours();
    setSpeed(run.start.speed);
}

function fillColours() {
    const optionsOf = (columns) => columns.map(({name}) => new Option(name, name));
    element("colour").replaceChildren(...optionsOf(run.columns));
    element("heat").replaceChildren(new Option("none", ""), new Option(DENSITY, DENSITY),
                                    ...optionsOf(run.columns.filter((column) => column.shades)));
}

// Shows what a configuration says.
function begin(viewOptions) {
    switches.begin(viewOptions);
    colourBy((run.columns.find((column) => column.name === viewOptions.color_by) ?? run.columns[0]).name);
    heatBy(viewOptions.heat_map ?? "");
    camera.fit(viewOptions.zoom ?? 1);
    follow(head.objects.findIndex(([category, id]) => id === viewOptions.follow && !head.categories[category].passive));
}

// Returns what is shown, as a configuration says it.
function chosen() {
    const id = state.followed < 0 ? undefined : head.objects[state.followed][1];
    return {...state.shows, color_by: state.colouring.name, heat_map: state.heat, follow: id};
}

const view = {
    state, camera, run, player, poses, painter, element, setTime, showPlaying, setSpeed, colourBy, heatBy, select,
    follow, fit, switches, chosen, redraw, draw, valuesOf, colourOf, showKey, fillColours, listen,
    // Takes the view out of the page: nothing listens or draws any more.
    end: () => ended.abort(),
};
player.attach(view);
fillControls();
listenToKeys();
listenToPointers(canvas, camera, listen, {
    objectAt, select, redraw, drag: player.drag?.bind(player), release: () => follow(-1),
    hover: (object) => { state.hovered = object; dirty = true; },
    // In another page, which is scrolled, the wheel zooms once the view has been clicked.
    isActive: () => (window === window.parent || document.hasFocus()) && (root === document || root.activeElement === canvas),
});
listenToControls();
begin(run.start.view);
resize();
setTime(run.times[0]);
showPlaying();
requestAnimationFrame(tick);
return view;
}
