// Shows a recorded run: reads the tables of the page, and draws them at any time.
"use strict";

(() => {
const MISSING = 65535;
const LEVELS = 65534;
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8, 16, 32];
const GLOW = 1.75;  // radius of a glow, in radii of its robot

const element = (id) => document.getElementById(id);
const head = JSON.parse(element("head").textContent);
const palette = head.palette;
const canvas = element("arena");
const pen = canvas.getContext("2d");
const times = Float64Array.from(head.times);
const count = head.objects.length;
const firstTime = times[0], lastTime = times[times.length - 1];
const low = head.low, high = head.high;
const size = [high[0] - low[0], high[1] - low[1]];

// ---- tables ----------------------------------------------------------------------------------------------------------

// Undoes what packing.py does: bytes to tables of 16-bit codes, object by object.
async function readTables(shapes) {
    const text = atob(element("data").textContent);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    const raw = new Uint8Array(await new Response(stream).arrayBuffer());
    const tables = [];
    let start = 0;
    for (const [rows, columns] of shapes) {
        const cells = rows * columns;
        const codes = new Uint16Array(cells);
        for (let object = 0, cell = 0; object < columns; object++) {
            let code = 0;
            for (let row = 0; row < rows; row++, cell++) {
                code = (code + raw[start + cell] + 256 * raw[start + cells + cell]) & 0xffff;
                codes[cell] = code;
            }
        }
        tables.push(codes);
        start += 2 * cells;
    }
    return tables;
}

// Rows and columns of every table, by its number.
function shapesOfTables() {
    const shapes = [];
    const poses = (own, rows, columns) => {
        for (const name of ["x", "y", "angle"]) shapes[own[name].table] = [rows, columns];
    };
    poses(head.poses, times.length, count);
    for (const column of head.columns) shapes[column.table] = [times.length, count];
    for (const [, table] of head.lights) shapes[table] = [1, head.lightCells * head.lightCells];
    if (head.membranes) poses(head.membranes.poses, head.membranes.times.length, head.membranes.dots);
    return shapes;
}

// The poses of many objects at any time.
class Track {
    constructor(tables, poses, ownTimes) {
        this.times = ownTimes;
        this.x = this.decoded(tables, poses.x);
        this.y = this.decoded(tables, poses.y);
        this.angle = this.decoded(tables, poses.angle);
    }

    decoded(tables, {table, low: least, high: greatest}) {
        const span = greatest > least ? greatest - least : 1;
        return Float32Array.from(tables[table], (code) => code === MISSING ? NaN : least + span * code / LEVELS);
    }

    // Number of the last time at or before a time.
    indexAt(time) {
        let first = 0, end = this.times.length;
        const slack = 1e-9 * Math.max(1, Math.abs(time));
        while (end - first > 1) {
            const middle = (first + end) >> 1;
            if (this.times[middle] <= time + slack) first = middle; else end = middle;
        }
        return first;
    }

    // Pose of an object, on the straight and shortest way between two times. See Timeline.at() in timeline.py.
    at(object, index, share, pose) {
        const length = this.times.length;
        const cell = object * length + index;
        pose.x = this.x[cell];
        pose.y = this.y[cell];
        pose.angle = this.angle[cell];
        if (share <= 0 || index + 1 >= length) return pose;
        let [dx, dy] = nearestImage(this.x[cell + 1] - pose.x, this.y[cell + 1] - pose.y);
        if (!head.periodic && (Math.abs(dx) > size[0] / 2 || Math.abs(dy) > size[1] / 2)) dx = dy = 0;
        pose.x += share * dx;
        pose.y += share * dy;
        if (head.periodic) {
            pose.x = wrapped(pose.x, 0);
            pose.y = wrapped(pose.y, 1);
        }
        const turn = this.angle[cell + 1] - pose.angle;
        if (turn === turn) pose.angle += share * (turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI)));
        return pose;
    }

    shareAt(time, index) {
        if (index + 1 >= this.times.length) return 0;
        const start = this.times[index];
        return Math.min(Math.max((time - start) / (this.times[index + 1] - start), 0), 1);
    }
}

// The shortest of all images of an offset; in an arena with walls, the offset itself.
function nearestImage(dx, dy) {
    if (!head.periodic) return [dx, dy];
    return [dx - size[0] * Math.round(dx / size[0]), dy - size[1] * Math.round(dy / size[1])];
}

function wrapped(value, axis) {
    if (value < low[axis]) return value + size[axis];
    return value > high[axis] ? value - size[axis] : value;
}

// A column of the data file: values, and the colours that stand for them.
class Column {
    constructor(tables, own) {
        Object.assign(this, own);
        this.codes = tables[own.table];
        if (!own.colours) {
            const shades = head.shades[own.shades];
            const span = own.to > own.from ? own.to - own.from : 0;
            this.shadeOf = (value) => {
                const share = span ? (value - own.from) / span : 0.5;
                return shades[Math.min(Math.max(Math.floor(share * shades.length), 0), shades.length - 1)];
            };
        }
    }

    value(object, index) {
        const code = this.codes[object * times.length + index];
        if (code === MISSING) return null;
        if (this.labels) return this.labels[code];
        return this.values ? this.values[code] : this.low + (this.high - this.low) * code / LEVELS;
    }

    colour(object, index) {
        const code = this.codes[object * times.length + index];
        if (code === MISSING) return palette.no_led;
        return this.colours ? this.colours[code] : this.shadeOf(this.value(object, index));
    }
}

// Columns that every run has, computed from the poses.
function poseColumn(name, valueOf, from, to, shades) {
    const own = head.shades[shades];
    const shadeOf = (value) => own[Math.min(Math.max(Math.floor((value - from) / ((to - from) || 1) * own.length), 0),
                                            own.length - 1)];
    return {name, from, to, shades, shadeOf, value: valueOf, colour: (object, index) => {
        const value = valueOf(object, index);
        return value === null || value !== value ? palette.no_led : shadeOf(value);
    }};
}

// ---- state -----------------------------------------------------------------------------------------------------------

let track, dots = null, columns, colouring, lights = [];
const state = {time: firstTime, playing: false, speed: 1, trails: false, links: false, follow: false,
               selected: -1, hovered: -1, tail: head.start.tail_s, frames: 0};
const camera = {x: 0, y: 0, scale: 1, fitted: true};
const poses = Array.from({length: count}, () => ({x: NaN, y: NaN, angle: NaN}));
const categoryOf = (object) => head.categories[head.objects[object][0]];
const floor = new Path2D();
let index = 0, dirty = true, before = null;

function setTime(time) {
    state.time = Math.min(Math.max(time, firstTime), lastTime);
    index = track.indexAt(state.time);
    const share = track.shareAt(state.time, index);
    for (let object = 0; object < count; object++) track.at(object, index, share, poses[object]);
    dirty = true;
}

function setPlaying(playing) {
    if (playing && state.time >= lastTime) setTime(firstTime);
    state.playing = playing && lastTime > firstTime;
    before = null;
    element("play").classList.toggle("playing", state.playing);
    element("play").setAttribute("aria-label", state.playing ? "Pause" : "Play");
}

function stepBy(records) {
    setPlaying(false);
    setTime(times[Math.min(Math.max(index + records, 0), times.length - 1)]);
}

function setSpeed(speed) {
    state.speed = speed;
    element("speed").value = String(speed);
}

function colourBy(name) {
    const found = columns.find((column) => column.name === name);
    if (!found) throw new Error(`no column ${name}`);
    colouring = found;
    element("colour").value = name;
    showKey();
    dirty = true;
}

function select(object) {
    state.selected = object;
    if (object < 0) setSwitch("follow", false);
    dirty = true;
}

function setSwitch(name, on) {
    state[name] = on;
    element(name).checked = on;
    dirty = true;
}

// ---- camera ----------------------------------------------------------------------------------------------------------

function fit() {
    const margin = 46;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    camera.scale = Math.max(Math.min((width - 32) / size[0], (height - 2 * margin) / size[1]), 1e-6);
    camera.x = (low[0] + high[0]) / 2;
    camera.y = (low[1] + high[1]) / 2;
    camera.fitted = true;
    setSwitch("follow", false);
}

function resize() {
    const ratio = window.devicePixelRatio || 1;
    canvas.width = Math.max(Math.round(canvas.clientWidth * ratio), 1);
    canvas.height = Math.max(Math.round(canvas.clientHeight * ratio), 1);
    if (camera.fitted) fit();
    dirty = true;
}

const toScreen = (x, y) => [(x - camera.x) * camera.scale + canvas.clientWidth / 2,
                            (y - camera.y) * camera.scale + canvas.clientHeight / 2];
const toArena = (px, py) => [(px - canvas.clientWidth / 2) / camera.scale + camera.x,
                             (py - canvas.clientHeight / 2) / camera.scale + camera.y];

function zoom(factor, px, py) {
    const [x, y] = toArena(px, py);
    const fitted = Math.min(canvas.clientWidth / size[0], canvas.clientHeight / size[1]);
    camera.scale = Math.min(Math.max(camera.scale * factor, fitted / 8), fitted * 400);
    camera.x = x - (px - canvas.clientWidth / 2) / camera.scale;
    camera.y = y - (py - canvas.clientHeight / 2) / camera.scale;
    camera.fitted = false;
    dirty = true;
}

// The object at a place on the screen, -1 if there is none; with a few pixels to spare.
function objectAt(px, py) {
    const [x, y] = toArena(px, py);
    let nearest = -1, least = Infinity;
    for (let object = 0; object < count; object++) {
        const [dx, dy] = nearestImage(x - poses[object].x, y - poses[object].y);
        const distance = Math.hypot(dx, dy);
        const radius = categoryOf(object).membrane ? 8 / camera.scale : categoryOf(object).radius + 3 / camera.scale;
        if (distance <= radius && distance < least) [nearest, least] = [object, distance];
    }
    return nearest;
}

// ---- drawing ---------------------------------------------------------------------------------------------------------

function pathOf(path, line) {
    line.forEach(([x, y], i) => i ? path.lineTo(x, y) : path.moveTo(x, y));
    path.closePath();
}

// The light of each moment as a small picture, to be stretched over the arena.
function makeLights(tables) {
    const lamplight = palette.lamplight.match(/\w\w/g).map((text) => parseInt(text, 16));
    lights = head.lights.map(([from, table]) => {
        const cells = head.lightCells;
        const picture = document.createElement("canvas");
        picture.width = picture.height = cells;
        const image = new ImageData(cells, cells);
        tables[table].forEach((level, cell) =>
            image.data.set([...lamplight, Math.round(level * palette.brightest_lamplight)], 4 * cell));
        picture.getContext("2d").putImageData(image, 0, 0);
        return {from, picture};
    });
}

const glows = new Map();

function glowOf(colour) {
    if (!glows.has(colour)) {
        const sprite = new OffscreenCanvas(64, 64);
        const ink = sprite.getContext("2d");
        const gradient = ink.createRadialGradient(32, 32, 32 / GLOW, 32, 32, 32);
        gradient.addColorStop(0, colour + "55");
        gradient.addColorStop(0.45, colour + "22");
        gradient.addColorStop(1, colour + "00");
        ink.fillStyle = gradient;
        ink.fillRect(0, 0, 64, 64);
        glows.set(colour, sprite.transferToImageBitmap());
    }
    return glows.get(colour);
}

const brightness = new Map();

function isBright(colour) {
    if (!brightness.has(colour)) {
        const value = parseInt(colour.slice(1), 16);
        brightness.set(colour, 0.299 * (value >> 16) + 0.587 * ((value >> 8) & 255) + 0.114 * (value & 255) > 64);
    }
    return brightness.get(colour);
}

// Calls draw(dx, dy) for every image of a place in a periodic arena that reaches into it; once elsewhere.
function forEachImage(x, y, reach, draw) {
    if (!head.periodic) return draw(0, 0);
    for (let i = -1; i <= 1; i++) {
        for (let j = -1; j <= 1; j++) {
            const [px, py] = [x + i * size[0], y + j * size[1]];
            const outside = px + reach < low[0] || px - reach > high[0] || py + reach < low[1] || py - reach > high[1];
            if (!outside) draw(i * size[0], j * size[1]);
        }
    }
}

// The colour of an object now. What has no LED is blue-grey, as where a column has no value.
const colourOf = (object) =>
    colouring.led && categoryOf(object).passive ? palette.no_led : colouring.colour(object, index);

function drawFloor() {
    pen.fillStyle = palette.floor;
    pen.fill(floor, "evenodd");
    const light = lights.filter(({from}) => from <= index).pop();
    if (light) pen.drawImage(light.picture, low[0], low[1], size[0], size[1]);
}

function drawWalls() {
    for (const wall of head.walls) {
        const colour = (wall.colours.filter(([from]) => from <= index).pop() || wall.colours[0])[1];
        const lines = new Path2D();
        wall.lines.forEach((line) => pathOf(lines, line));
        pen.strokeStyle = colour;
        for (const [width, opacity] of [[22, 0.10], [15, 0.16], [8, 0.28], [2.4, 1]]) {
            pen.globalAlpha = opacity;
            pen.lineWidth = width / camera.scale;
            pen.stroke(lines);
        }
        pen.globalAlpha = 1;
    }
}

function drawLamps() {
    for (const {centre, orbit} of head.lamps) {
        const angle = orbit[2] + orbit[1] * state.time;
        const x = centre[0] + orbit[0] * Math.cos(angle), y = centre[1] + orbit[0] * Math.sin(angle);
        const radius = 5 / camera.scale;
        pen.fillStyle = pen.strokeStyle = palette.lamp;
        pen.lineWidth = 1.5 / camera.scale;
        pen.beginPath();
        pen.arc(x, y, radius, 0, 2 * Math.PI);
        pen.fill();
        pen.beginPath();
        for (let ray = 0; ray < 8; ray++) {
            const [dx, dy] = [Math.cos(ray * Math.PI / 4), Math.sin(ray * Math.PI / 4)];
            pen.moveTo(x + 1.4 * radius * dx, y + 1.4 * radius * dy);
            pen.lineTo(x + 2.1 * radius * dx, y + 2.1 * radius * dy);
        }
        pen.stroke();
    }
}

// Each trail in a few pieces, every one in the colour of its time, fading into the past.
function drawTrails() {
    const start = track.indexAt(Math.max(state.time - state.tail, firstTime));
    if (index <= start) return;
    const pieces = Math.min(count > 300 ? 5 : 12, index - start);
    const stride = Math.max(1, Math.round((index - start) / (count > 300 ? 25 : 120)));
    const length = times.length;
    pen.lineCap = pen.lineJoin = "round";
    for (let piece = 0; piece < pieces; piece++) {
        const from = start + Math.floor((index - start) * piece / pieces);
        const to = start + Math.floor((index - start) * (piece + 1) / pieces);
        const freshness = (piece + 1) / pieces;
        const paths = new Map();  // by colour
        for (let object = 0; object < count; object++) {
            if (categoryOf(object).membrane) continue;
            const colour = colouring.colour(object, to);
            if (!paths.has(colour)) paths.set(colour, new Path2D());
            const path = paths.get(colour);
            let [x, y] = [NaN, NaN];
            const lead = (toX, toY) => {
                if (Math.abs(toX - x) <= size[0] / 2 && Math.abs(toY - y) <= size[1] / 2) {
                    path.lineTo(toX, toY);
                } else if (head.periodic && x === x && toX === toX) {  // across the border: one line from either end
                    const [dx, dy] = nearestImage(toX - x, toY - y);
                    path.lineTo(x + dx, y + dy);
                    path.moveTo(toX - dx, toY - dy);
                    path.lineTo(toX, toY);
                } else {
                    path.moveTo(toX, toY);
                }
                [x, y] = [toX, toY];
            };
            for (let i = from; i < to; i += stride) lead(track.x[object * length + i], track.y[object * length + i]);
            lead(track.x[object * length + to], track.y[object * length + to]);
            if (piece === pieces - 1) lead(poses[object].x, poses[object].y);
        }
        pen.globalAlpha = 0.05 + 0.7 * freshness ** 2;
        pen.lineWidth = (0.8 + freshness) / camera.scale;
        for (const [colour, path] of paths) {
            pen.strokeStyle = colour;
            pen.stroke(path);
        }
    }
    pen.globalAlpha = 1;
}

// Pairs of robots near enough to hear each other: max(range of a, range of b) + radius of a + radius of b.
function linkedPairs() {
    const talkers = [];
    let furthest = 0;
    for (let object = 0; object < count; object++) {
        const own = categoryOf(object);
        if (!own.talks || !(poses[object].x === poses[object].x)) continue;
        talkers.push(object);
        if (own.range > 0) furthest = Math.max(furthest, own.range);
    }
    if (furthest <= 0) return [];
    const reach = furthest + 2 * Math.max(...head.categories.filter((own) => own.talks).map((own) => own.radius));
    const cells = [0, 1].map((axis) => Math.max(1, Math.min(Math.floor(size[axis] / reach), 1000)));
    const place = (value, axis) =>
        Math.min(Math.max(Math.floor((value - low[axis]) / size[axis] * cells[axis]), 0), cells[axis] - 1);
    const grid = new Map();
    const pairs = [];
    for (const object of talkers) {
        const {x, y} = poses[object];
        const [column, row] = [place(x, 0), place(y, 1)];
        const seen = new Set();
        for (let i = -1; i <= 1; i++) {
            for (let j = -1; j <= 1; j++) {
                let [c, r] = [column + i, row + j];
                if (head.periodic) [c, r] = [(c + cells[0]) % cells[0], (r + cells[1]) % cells[1]];
                const key = r * 4096 + c;
                if (seen.has(key)) continue;
                seen.add(key);
                for (const other of grid.get(key) || []) {
                    const [dx, dy] = nearestImage(poses[other].x - x, poses[other].y - y);
                    const [a, b] = [categoryOf(object), categoryOf(other)];
                    const range = Math.max(a.range, b.range);
                    if (range > 0 && Math.hypot(dx, dy) <= range + a.radius + b.radius) {
                        pairs.push({from: other, to: object, dx: -dx, dy: -dy});
                    }
                }
            }
        }
        const key = row * 4096 + column;
        if (!grid.has(key)) grid.set(key, []);
        grid.get(key).push(object);
    }
    return pairs;
}

function drawLinks() {
    pen.strokeStyle = palette.link_by_all_emitters;
    pen.globalAlpha = 0.55;
    pen.lineWidth = 1.1 / camera.scale;
    pen.beginPath();
    for (const {from, to, dx, dy} of linkedPairs()) {
        const [a, b] = [poses[from], poses[to]];
        pen.moveTo(a.x, a.y);
        pen.lineTo(a.x + dx, a.y + dy);
        if (Math.abs(a.x + dx - b.x) + Math.abs(a.y + dy - b.y) > 1e-3) {
            pen.moveTo(b.x, b.y);
            pen.lineTo(b.x - dx, b.y - dy);
        }
    }
    pen.stroke();
    pen.globalAlpha = 1;
}

function drawGlows() {
    if (!colouring.led) return;
    for (let object = 0; object < count; object++) {
        const own = categoryOf(object), {x, y} = poses[object];
        const colour = colourOf(object);
        if (own.passive || own.membrane || colour === palette.dark_led || !(x === x)) continue;
        const reach = GLOW * own.radius;
        forEachImage(x, y, reach, (dx, dy) =>
            pen.drawImage(glowOf(colour), x + dx - reach, y + dy - reach, 2 * reach, 2 * reach));
    }
}

function drawMembranes() {
    if (!dots) return;
    const at = dots.indexAt(state.time), share = dots.shareAt(state.time, at);
    const pose = {};
    for (const group of head.membranes.groups) {
        const places = [];  // from dot to dot on the shortest way, maybe out of the arena
        for (let i = 0; i < group.count; i++) {
            dots.at(group.first + i, at, share, pose);
            if (!(pose.x === pose.x)) continue;
            const [x, y] = places[places.length - 1] || [pose.x, pose.y];
            const [dx, dy] = nearestImage(pose.x - x, pose.y - y);
            places.push([x + dx, y + dy]);
        }
        if (!places.length) continue;
        const [xs, ys] = [places.map(([x]) => x), places.map(([, y]) => y)];
        const middle = [(Math.min(...xs) + Math.max(...xs)) / 2, (Math.min(...ys) + Math.max(...ys)) / 2];
        const reach = Math.max(...places.map(([x, y]) => Math.hypot(x - middle[0], y - middle[1])));
        pen.strokeStyle = pen.fillStyle = group.object !== null ? colourOf(group.object) : palette.dark_led;
        pen.lineJoin = "round";
        pen.lineWidth = 2 * group.half_thickness * (group.segments ? 1 : 1 / 3);
        forEachImage(...middle, reach + group.half_thickness, (dx, dy) => {
            const line = new Path2D();
            pathOf(line, places.map(([x, y]) => [x + dx, y + dy]));
            pen.globalAlpha = 0.5;
            pen.stroke(line);
            pen.globalAlpha = 1;
            for (const [x, y] of places) {
                pen.beginPath();
                pen.arc(x + dx, y + dy, group.half_thickness * (group.segments ? 0.35 : 1), 0, 2 * Math.PI);
                pen.fill();
            }
        });
    }
}

function bodyPath(own, x, y, angle, scale = 1) {
    pen.beginPath();
    if (!own.outline) {
        pen.arc(x, y, own.radius * scale, 0, 2 * Math.PI);
        return;
    }
    const [cos, sin] = angle === angle ? [Math.cos(angle) * scale, Math.sin(angle) * scale] : [scale, 0];
    own.outline.forEach(([u, v], i) => {
        const [px, py] = [x + u * cos - v * sin, y + u * sin + v * cos];
        if (i) pen.lineTo(px, py); else pen.moveTo(px, py);
    });
    pen.closePath();
}

// Small disks with their rims as pictures, made once for each colour and zoom; twice as fine as the screen.
const MAX_SPRITE = 48;  // pixels of a radius
const MAX_SPRITES = 2000;
const sprites = new Map();  // by radius, then by colour
let spriteCount = 0, spritePixel = 0;

function spriteOf(colour, radius, pixel) {
    if (pixel !== spritePixel || spriteCount >= MAX_SPRITES) {
        sprites.clear();
        [spriteCount, spritePixel] = [0, pixel];
    }
    if (!sprites.has(radius)) sprites.set(radius, new Map());
    let sprite = sprites.get(radius).get(colour);
    if (!sprite) {
        const half = Math.ceil(radius / pixel) + 2;
        const picture = new OffscreenCanvas(4 * half, 4 * half);
        const ink = picture.getContext("2d");
        ink.arc(2 * half, 2 * half, 2 * radius / pixel, 0, 2 * Math.PI);
        ink.fillStyle = colour;
        ink.fill();
        ink.strokeStyle = palette.edge;
        ink.lineWidth = 2 * 1.2 * (window.devicePixelRatio || 1);
        ink.stroke();
        sprite = {image: picture.transferToImageBitmap(), reach: half * pixel};
        sprites.get(radius).set(colour, sprite);
        spriteCount++;
    }
    return sprite;
}

function drawBodies() {
    const pixel = 1 / camera.scale;
    const fine = pixel / (canvas.width / Math.max(canvas.clientWidth, 1));  // pixel of the screen, mm
    const [left, top] = toArena(0, 0), [right, bottom] = toArena(canvas.clientWidth, canvas.clientHeight);
    const ticks = head.categories.map(() => [new Path2D(), new Path2D()]);  // on dark and on bright bodies
    for (let object = 0; object < count; object++) {
        const own = categoryOf(object), {x, y, angle} = poses[object];
        if (!(x === x) || (own.membrane && dots)) continue;
        const colour = colourOf(object);
        const sprite = own.outline || own.membrane || own.radius > MAX_SPRITE * fine ? null
            : spriteOf(colour, own.radius, fine);
        const tick = ticks[head.objects[object][0]][Number(isBright(colour))];
        forEachImage(x, y, own.radius, (dx, dy) => {
            const [px, py] = [x + dx, y + dy], margin = own.radius + 12 * pixel;
            if (px + margin < left || px - margin > right || py + margin < top || py - margin > bottom) return;
            if (own.membrane) return drawMark(px, py, colour);
            if (sprite) {
                pen.drawImage(sprite.image, px - sprite.reach, py - sprite.reach, 2 * sprite.reach, 2 * sprite.reach);
            } else {
                bodyPath(own, px, py, angle);
                pen.fillStyle = colour;
                pen.fill();
                pen.strokeStyle = palette.edge;
                pen.lineWidth = 1.2 * pixel;
                pen.stroke();
            }
            if (angle !== angle) return;
            const [cos, sin] = [Math.cos(angle) * own.reach, Math.sin(angle) * own.reach];
            tick.moveTo(px + 0.25 * cos, py + 0.25 * sin);
            tick.lineTo(px + 0.95 * cos, py + 0.95 * sin);
        });
    }
    drawBodyLinks();
    pen.lineCap = "butt";
    ticks.forEach((paths, category) => paths.forEach((path, bright) => {
        pen.strokeStyle = bright ? palette.edge : palette.paper;
        pen.lineWidth = Math.min(2.2 * pixel, head.categories[category].reach / 4);
        pen.stroke(path);
    }));
}

// Where links between bodies are now, as in body_links.py: those that hold, with their load from -1 to 1.
function placedLinks() {
    const links = head.bodyLinks, placed = [];
    if (!links) return placed;
    const late = state.time + 1e-9 * Math.max(1, Math.abs(state.time));
    const place = (object, [u, v]) => {
        if (object === -1) return [u, v];
        const {x, y, angle} = poses[object];
        const [cos, sin] = angle === angle ? [Math.cos(angle), Math.sin(angle)] : [1, 0];
        return [x + u * cos - v * sin, y + u * sin + v * cos];
    };
    let largest = links.leastTension;
    for (let i = 0; i < links.a.length; i++) {
        const [a, b, breaking] = [links.a[i], links.b[i], links.breaking[i]];
        if (links.made[i] > late || links.cut[i] <= late || a < 0 || b < -1) continue;
        const [x, y] = place(a, links.endA[i]), [toX, toY] = place(b, links.endB[i]);
        const [dx, dy] = nearestImage(toX - x, toY - y);
        if (dx !== dx || dy !== dy) continue;
        const stretch = Math.hypot(dx, dy) - links.rest[i];
        const tension = links.kind[i] === "spring" ? links.stiffness[i] * stretch : 0;
        if (breaking === null) largest = Math.max(largest, Math.abs(tension));
        placed.push({x, y, dx, dy, kind: links.kind[i], isPinned: b === -1, tension, breaking});
    }
    for (const link of placed) {
        const most = link.breaking === null ? largest : link.breaking;
        link.load = Math.min(Math.max(link.tension / most, -1), 1);
    }
    return placed;
}

const channels = (colour) => colour.match(/\w\w/g).map((text) => parseInt(text, 16));

function tensionColour(load) {
    const [from, to] = [palette.link_at_rest, load < 0 ? palette.link_pushed : palette.link_pulled].map(channels);
    return `rgb(${from.map((own, i) => Math.round(own + Math.abs(load) * (to[i] - own))).join(",")})`;
}

function drawDot(x, y, radius, colour) {
    pen.beginPath();
    pen.arc(x, y, (radius + 0.6) / camera.scale, 0, 2 * Math.PI);
    pen.fillStyle = palette.edge;
    pen.fill();
    pen.beginPath();
    pen.arc(x, y, radius / camera.scale, 0, 2 * Math.PI);
    pen.fillStyle = colour;
    pen.fill();
}

function drawBodyLinks() {
    pen.lineCap = "round";
    for (const {x, y, dx, dy, kind, isPinned, load} of placedLinks()) {
        const colour = tensionColour(load);
        forEachImage(x + dx / 2, y + dy / 2, Math.hypot(dx, dy) / 2 + 4 / camera.scale, (ox, oy) => {
            const [px, py] = [x + ox, y + oy];
            if (kind === "hinge") return drawDot(px, py, 3.6, colour);
            const width = kind === "rod" ? 3 : 2;
            for (const [own, extra] of [[palette.edge, 1.2], [colour, 0]]) {
                pen.strokeStyle = own;
                pen.lineWidth = (width + extra) / camera.scale;
                pen.beginPath();
                pen.moveTo(px, py);
                pen.lineTo(px + dx, py + dy);
                pen.stroke();
            }
            if (isPinned) drawDot(px + dx, py + dy, 2.6, colour);
        });
    }
}

// A membrane whose dots the file does not have.
function drawMark(x, y, colour) {
    const side = 6 / camera.scale;
    pen.strokeStyle = colour;
    pen.lineWidth = 2 / camera.scale;
    pen.strokeRect(x - side, y - side, 2 * side, 2 * side);
}

function drawSelection() {
    for (const [object, colour, width] of [[state.hovered, "#ffffff", 1.5], [state.selected, palette.selection_rim, 3]]) {
        if (object < 0 || !(poses[object].x === poses[object].x)) continue;
        const own = categoryOf(object), {x, y, angle} = poses[object];
        const larger = 1 + 3 / (camera.scale * own.radius);
        forEachImage(x, y, own.radius * larger, (dx, dy) => {
            bodyPath(own, x + dx, y + dy, angle, larger);
            pen.strokeStyle = palette.selection;
            pen.lineWidth = (width + 1.5) / camera.scale;
            pen.stroke();
            pen.strokeStyle = colour;
            pen.lineWidth = width / camera.scale;
            pen.stroke();
        });
    }
}

function drawScaleBar() {
    const most = Math.min(canvas.clientWidth / 4, 180) / camera.scale;
    const power = 10 ** Math.floor(Math.log10(most));
    const length = power * [5, 2, 1].find((step) => step * power <= most);
    const y = canvas.clientHeight - 22;
    pen.fillStyle = palette.ink;
    pen.fillRect(16, y, length * camera.scale, 2.5);
    pen.font = "12px system-ui, 'DejaVu Sans', sans-serif";
    pen.fillText(`${Number(length.toPrecision(3))} mm`, 16, y + 16);
}

function draw() {
    if (state.follow && state.selected >= 0) {
        const {x, y} = poses[state.selected];
        if (x === x) [camera.x, camera.y, camera.fitted] = [x, y, false];
    }
    const ratio = canvas.width / Math.max(canvas.clientWidth, 1);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.fillStyle = palette.paper;
    pen.fillRect(0, 0, canvas.clientWidth, canvas.clientHeight);
    const scale = camera.scale * ratio;
    const [left, top] = toScreen(0, 0);
    pen.setTransform(scale, 0, 0, scale, left * ratio, top * ratio);
    pen.save();
    pen.clip(floor, "evenodd");
    drawFloor();
    drawWalls();
    drawLamps();
    if (state.trails) drawTrails();
    if (state.links) drawLinks();
    drawGlows();
    if (!head.periodic) pen.restore();
    drawMembranes();
    drawBodies();
    if (head.periodic) {
        drawSelection();
        pen.restore();
    }
    pen.strokeStyle = palette.wall;
    pen.lineWidth = 3 / camera.scale;
    pen.lineJoin = "round";
    pen.stroke(floor);
    if (!head.periodic) drawSelection();
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    drawScaleBar();
    element("clock").textContent = `${state.time.toFixed(2)} s`;
    element("scrub").value = String(state.time);
    element("scrub").setAttribute("aria-valuetext", `${state.time.toFixed(2)} seconds`);
    showRobot();
    state.frames++;
}

function tick(now) {
    if (state.playing) {
        if (before !== null) setTime(state.time + Math.min((now - before) / 1000, 0.25) * state.speed);
        before = now;
        dirty = true;
        if (state.time >= lastTime) setPlaying(false);
    }
    if (dirty) {
        dirty = false;
        draw();
    }
    requestAnimationFrame(tick);
}

// ---- panels ----------------------------------------------------------------------------------------------------------

const rounded = (value) => typeof value === "number" ? String(Number(value.toPrecision(6))) : String(value);

// Values of all columns of an object, in the order of the file.
function valuesOf(object) {
    const values = {category: categoryOf(object).name, id: head.objects[object][1]};
    const {x, y, angle} = poses[object];
    for (const [name, value] of [["x", x], ["y", y], ["angle", angle]]) {
        if (value === value) values[name] = Number(value.toFixed(name === "angle" ? 4 : 2));
    }
    for (const column of columns) {
        if (!column.codes || (column.base && !column.led)) continue;
        const name = column.name in values ? `${column.name} (column)` : column.name;
        values[name] = column.value(object, index);
    }
    return values;
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
    const [x, y] = toScreen(poses[state.hovered].x, poses[state.hovered].y);
    tip.style.left = `${Math.max(4, Math.min(x + 18, canvas.clientWidth - tip.offsetWidth - 8))}px`;
    tip.style.top = `${Math.max(4, Math.min(y + 14, canvas.clientHeight - tip.offsetHeight - 8))}px`;
}

function heading(text) {
    const own = document.createElement("h2");
    own.textContent = text;
    return own;
}

// What the colours mean: a bar for numbers, a list for names, nothing for LEDs.
function showKey() {
    const key = element("key");
    key.hidden = Boolean(colouring.led);
    key.replaceChildren(heading(colouring.name));
    if (colouring.labels && !colouring.base) {
        colouring.labels.slice(0, 40).forEach((label, i) => key.append(entry(label, colouring.colours[i])));
        if (colouring.labels.length > 40) key.append(`and ${colouring.labels.length - 40} more`);
    } else if (colouring.base) {
        head.categories.forEach((own, category) => {
            if (head.categories.findIndex(({name}) => name === own.name) !== category) return;  // one of several kinds
            const object = head.objects.findIndex(([number]) => number === category);
            key.append(entry(own.name, colouring.colour(object, times.length - 1)));
        });
    } else {
        const bar = document.createElement("div");
        bar.className = "bar";
        const shades = head.shades[colouring.shades];
        bar.style.background = `linear-gradient(to right, ${shades.filter((_, i) => i % 15 === 0).join(", ")})`;
        const ends = document.createElement("div");
        ends.className = "ends";
        ends.append(...[colouring.from, colouring.to].map((value) => {
            const end = document.createElement("span");
            end.textContent = String(Number(value.toPrecision(4)));
            return end;
        }));
        key.append(bar, ends);
    }
}

function entry(label, colour) {
    const line = document.createElement("div");
    const swatch = document.createElement("span");
    swatch.className = "swatch";
    swatch.style.background = colour;
    line.append(swatch, label);
    return line;
}

// ---- controls --------------------------------------------------------------------------------------------------------

function toggleHelp(show = element("help").hidden) {
    element("help").hidden = !show;
}

const KEYS = {
    " ": () => setPlaying(!state.playing),
    ArrowLeft: (event) => stepBy(event.shiftKey ? -10 : -1),
    ArrowRight: (event) => stepBy(event.shiftKey ? 10 : 1),
    Home: () => stepBy(-times.length),
    End: () => stepBy(times.length),
    "+": () => setSpeed(nextSpeed(1)),
    "=": () => setSpeed(nextSpeed(1)),
    "-": () => setSpeed(nextSpeed(-1)),
    t: () => setSwitch("trails", !state.trails),
    l: () => setSwitch("links", !state.links),
    f: () => setSwitch("follow", !state.follow && state.selected >= 0),
    0: fit,
    "?": () => toggleHelp(),
    Escape: () => { toggleHelp(false); select(-1); },
};

function nextSpeed(direction) {
    const known = [...element("speed").options].map((option) => Number(option.value));
    const place = known.indexOf(state.speed) + direction;
    return known[Math.min(Math.max(place, 0), known.length - 1)];
}

function listenToKeys() {
    document.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        const own = event.target;
        if (own.tagName === "SELECT" || (own.type === "checkbox" && event.key === " ")) return;
        const action = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
        if (!action) return;
        event.preventDefault();
        action(event);
    });
    // A space that has been taken as play must not also press the button that has the focus.
    document.addEventListener("keyup", (event) => {
        if (event.key === " " && event.target.tagName === "BUTTON") event.preventDefault();
    });
}

function listenToMouse() {
    let drag = null;
    const place = (event) => [event.offsetX, event.offsetY];
    canvas.addEventListener("wheel", (event) => {
        if (window !== window.parent && !document.hasFocus()) return;  // in another page, which is scrolled
        event.preventDefault();
        zoom(Math.exp(-event.deltaY * (event.deltaMode ? 0.03 : 0.0015)), ...place(event));
    }, {passive: false});
    canvas.addEventListener("pointerdown", (event) => {
        drag = {at: place(event), camera: [camera.x, camera.y], moved: false};
        canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
        const [px, py] = place(event);
        if (drag) {
            const [dx, dy] = [px - drag.at[0], py - drag.at[1]];
            drag.moved = drag.moved || Math.hypot(dx, dy) > 4;
            if (!drag.moved) return;
            setSwitch("follow", false);
            [camera.x, camera.y] = [drag.camera[0] - dx / camera.scale, drag.camera[1] - dy / camera.scale];
            camera.fitted = false;
        } else {
            state.hovered = objectAt(px, py);
            canvas.style.cursor = state.hovered < 0 ? "default" : "pointer";
        }
        dirty = true;
    });
    canvas.addEventListener("pointerup", (event) => {
        if (drag && !drag.moved) select(objectAt(...place(event)));
        drag = null;
    });
    canvas.addEventListener("pointerleave", () => { state.hovered = -1; dirty = true; });
}

function listenToControls() {
    element("play").addEventListener("click", () => setPlaying(!state.playing));
    element("scrub").addEventListener("input", (event) => { setPlaying(false); setTime(Number(event.target.value)); });
    element("speed").addEventListener("change", (event) => setSpeed(Number(event.target.value)));
    element("colour").addEventListener("change", (event) => colourBy(event.target.value));
    for (const name of ["trails", "links", "follow"]) {
        element(name).addEventListener("change", (event) => setSwitch(name, event.target.checked));
    }
    element("fit").addEventListener("click", fit);
    element("ask").addEventListener("click", () => toggleHelp());
    new ResizeObserver(resize).observe(canvas);
}

// ---- start -----------------------------------------------------------------------------------------------------------

function fillControls() {
    element("title").textContent = head.title;
    element("notes").textContent = head.notes;
    const scrub = element("scrub");
    [scrub.min, scrub.max] = [String(firstTime), String(lastTime)];
    const speeds = [...new Set([...SPEEDS, head.start.speed])].sort((a, b) => a - b);
    element("speed").append(...speeds.map((speed) => new Option(`${Number(speed.toPrecision(3))} ×`, String(speed))));
    element("colour").append(...columns.map((column) => new Option(column.name, column.name)));
    setSpeed(head.start.speed);
    setSwitch("trails", head.start.trails);
    setSwitch("links", head.start.links);
    head.polygons.forEach((line) => pathOf(floor, line));
}

function makeColumns(tables) {
    const length = times.length;
    const of = (values) => (object, at) => values[object * length + at];
    const ids = head.objects.map(([, id]) => id).filter((id) => id !== null);
    const [least, most] = [ids.reduce((a, b) => Math.min(a, b), Infinity), ids.reduce((a, b) => Math.max(a, b), -Infinity)];
    columns = head.columns.map((own) => new Column(tables, own));
    const names = new Set(columns.map((column) => column.name));
    const more = [
        poseColumn("robot_id", (object) => head.objects[object][1], least, most, "number"),
        poseColumn("x", of(track.x), head.poses.x.low, head.poses.x.high, "number"),
        poseColumn("y", of(track.y), head.poses.y.low, head.poses.y.high, "number"),
        poseColumn("angle", of(track.angle), -Math.PI, Math.PI, "angle"),
    ];
    columns.push(...more.filter((column) => !names.has(column.name)));
}

async function start() {
    const tables = await readTables(shapesOfTables());
    track = new Track(tables, head.poses, times);
    if (head.membranes) dots = new Track(tables, head.membranes.poses, Float64Array.from(head.membranes.times));
    makeColumns(tables);
    makeLights(tables);
    fillControls();
    colourBy(columns.some((column) => column.name === head.start.colourBy) ? head.start.colourBy : columns[0].name);
    listenToKeys();
    listenToMouse();
    listenToControls();
    resize();
    fit();
    setTime(firstTime);
    requestAnimationFrame(tick);
}

// What programs that drive the page may use.
window.replay = {
    get time() { return state.time; },
    get playing() { return state.playing; },
    get frames() { return state.frames; },
    get selected() { return state.selected; },
    get hovered() { return state.hovered; },
    get colouring() { return colouring.name; },
    get columns() { return columns.map((column) => column.name); },
    get links() { return linkedPairs().map(({from, to}) => [from, to]); },
    get bodyLinks() {
        return placedLinks().map(({x, y, dx, dy, kind, load}) => ({from: [x, y], to: [x + dx, y + dy], kind, load}));
    },
    count, times: head.times,
    play: () => setPlaying(true),
    pause: () => setPlaying(false),
    setTime, colourBy, select, fit, valuesOf, colourOf,
    redraw: draw,
    object: (category, id) => head.objects.findIndex(([own, number]) =>
        head.categories[own].name === category && number === id),
    pose: (object) => ({...poses[object]}),
    screen: (object) => toScreen(poses[object].x, poses[object].y),
    ready: start().catch((error) => {
        const problem = element("problem");
        problem.textContent = `This browser cannot show the replay: ${error.message}`;
        problem.hidden = false;
        throw error;
    }),
};
})();
