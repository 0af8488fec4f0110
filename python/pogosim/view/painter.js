// Draws a run at one moment: the arena, its light and its objects.

const GLOW = 1.75;  // radius of a glow, in radii of its robot
const MAX_SPRITE = 48;  // pixels of a radius
const MAX_SPRITES = 2000;
const PLATE = 0.8;  // opacity of the paper below letters, which may lie on the floor

function pathOf(path, line) {
    line.forEach(([x, y], i) => i ? path.lineTo(x, y) : path.moveTo(x, y));
    path.closePath();
}

// view: run, canvas, camera, poses of the objects now, and the state: what is chosen to be seen, and when.
function makePainter({run, canvas, camera, poses, state}) {
const {head, space, colours} = run;
const pen = canvas.getContext("2d");
const count = head.objects.length;
const categoryOf = (object) => head.categories[head.objects[object][0]];
const scene = {run, pen, camera, poses, state, categoryOf};  // what the functions of other files draw from
const floor = new Path2D();
head.polygons.forEach((line) => pathOf(floor, line));

const glows = new Cache(MAX_SPRITES);

function glowOf(colour) {
    return glows.get(colour, () => {
        const sprite = new OffscreenCanvas(64, 64);
        const ink = sprite.getContext("2d");
        const gradient = ink.createRadialGradient(32, 32, 32 / GLOW, 32, 32, 32);
        gradient.addColorStop(0, colour + "55");
        gradient.addColorStop(0.45, colour + "22");
        gradient.addColorStop(1, colour + "00");
        ink.fillStyle = gradient;
        ink.fillRect(0, 0, 64, 64);
        return sprite.transferToImageBitmap();
    });
}

// The colour of an object now. What has no LED is blue-grey, as where a column has no value.
const colourOf = (object) =>
    state.colouring.led && categoryOf(object).passive ? colours.no_led : state.colouring.colour(object, state.index);

function drawFloor() {
    pen.fillStyle = colours.floor;
    pen.fill(floor, "evenodd");
    const light = state.shows.light_levels ? run.lightAt(state.index) : null;
    if (light) pen.drawImage(light.picture(colours), ...space.low, ...space.size);
}

const robots = Array.from(poses.keys()).filter((object) => !categoryOf(object).passive && !categoryOf(object).membrane);

const maps = new Cache(1);

// Returns what its colours mean; null: there is no heat map.
function drawHeatMap() {
    if (!state.heat) return null;
    const map = maps.get([state.time, run.version, state.heat, colours.version].join(), () =>
        heatMap({space, colours, poses, column: state.heatColumn, index: state.index, robots}));
    pen.drawImage(map.picture, ...space.low, map.width, map.height);
    return map;
}

function drawWalls() {
    for (const wall of head.walls) {
        const colour = run.wallColour(wall, state.index);
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
        pen.fillStyle = pen.strokeStyle = colours.lamp;
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

function drawGlows() {
    if (!state.colouring.led) return;
    for (let object = 0; object < count; object++) {
        const own = categoryOf(object), {x, y} = poses[object];
        const colour = colourOf(object);
        if (own.passive || own.membrane || colour === colours.dark_led || !(x === x)) continue;
        const reach = GLOW * own.radius;
        space.forEachImage(x, y, reach, (dx, dy) =>
            pen.drawImage(glowOf(colour), x + dx - reach, y + dy - reach, 2 * reach, 2 * reach));
    }
}

function drawMembranes() {
    if (!run.dots) return;
    const at = run.dots.indexAt(state.time), share = run.dots.shareAt(state.time, at);
    const pose = {};
    for (const group of head.membranes.groups) {
        const places = [];  // from dot to dot on the shortest way, maybe out of the arena
        for (let i = 0; i < group.count; i++) {
            run.dots.at(group.first + i, at, share, pose);
            if (!(pose.x === pose.x)) continue;
            const [x, y] = places[places.length - 1] || [pose.x, pose.y];
            const [dx, dy] = space.nearestImage(pose.x - x, pose.y - y);
            places.push([x + dx, y + dy]);
        }
        if (!places.length) continue;
        const [xs, ys] = [places.map(([x]) => x), places.map(([, y]) => y)];
        const middle = [(Math.min(...xs) + Math.max(...xs)) / 2, (Math.min(...ys) + Math.max(...ys)) / 2];
        const reach = Math.max(...places.map(([x, y]) => Math.hypot(x - middle[0], y - middle[1])));
        pen.strokeStyle = pen.fillStyle = group.object !== null ? colourOf(group.object) : colours.dark_led;
        pen.lineJoin = "round";
        pen.lineWidth = 2 * group.half_thickness * (group.segments ? 1 : 1 / 3);
        space.forEachImage(...middle, reach + group.half_thickness, (dx, dy) => {
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
let sprites = new Cache(MAX_SPRITES), spritePixel = 0, spriteVersion = 0;

function spriteOf(colour, radius, pixel) {
    if (pixel !== spritePixel || colours.version !== spriteVersion) {
        sprites = new Cache(MAX_SPRITES);
        [spritePixel, spriteVersion] = [pixel, colours.version];
    }
    return sprites.get(`${colour} ${radius}`, () => {
        const half = Math.ceil(radius / pixel) + 2;
        const picture = new OffscreenCanvas(4 * half, 4 * half);
        const ink = picture.getContext("2d");
        ink.arc(2 * half, 2 * half, 2 * radius / pixel, 0, 2 * Math.PI);
        ink.fillStyle = colour;
        ink.fill();
        ink.strokeStyle = colours.edge;
        ink.lineWidth = 2 * 1.2 * (window.devicePixelRatio || 1);
        ink.stroke();
        return {image: picture.transferToImageBitmap(), reach: half * pixel};
    });
}

function drawBodies() {
    const pixel = 1 / camera.scale;
    const fine = pixel / (canvas.width / Math.max(canvas.clientWidth, 1));  // pixel of the screen, mm
    const [left, top] = camera.toArena(0, 0), [right, bottom] = camera.toArena(canvas.clientWidth, canvas.clientHeight);
    const ticks = head.categories.map(() => [new Path2D(), new Path2D()]);  // on dark and on bright bodies
    for (let object = 0; object < count; object++) {
        const own = categoryOf(object), {x, y, angle} = poses[object];
        if (!(x === x) || (own.membrane && run.dots)) continue;
        const colour = colourOf(object);
        const sprite = own.outline || own.membrane || own.radius > MAX_SPRITE * fine ? null
            : spriteOf(colour, own.radius, fine);
        const tick = ticks[head.objects[object][0]][Number(colours.contrastTo(colour) === colours.edge)];
        space.forEachImage(x, y, own.radius, (dx, dy) => {
            const [px, py] = [x + dx, y + dy], margin = own.radius + 12 * pixel;
            if (px + margin < left || px - margin > right || py + margin < top || py - margin > bottom) return;
            if (own.membrane) return drawMark(px, py, colour);
            if (sprite) {
                pen.drawImage(sprite.image, px - sprite.reach, py - sprite.reach, 2 * sprite.reach, 2 * sprite.reach);
            } else {
                bodyPath(own, px, py, angle);
                pen.fillStyle = colour;
                pen.fill();
                pen.strokeStyle = colours.edge;
                pen.lineWidth = 1.2 * pixel;
                pen.stroke();
            }
            if (angle !== angle) return;
            const [cos, sin] = [Math.cos(angle) * own.reach, Math.sin(angle) * own.reach];
            tick.moveTo(px + 0.25 * cos, py + 0.25 * sin);
            tick.lineTo(px + 0.95 * cos, py + 0.95 * sin);
        });
    }
    drawBodyLinks(scene);
    pen.lineCap = "butt";
    ticks.forEach((paths, category) => paths.forEach((path, bright) => {
        pen.strokeStyle = bright ? colours.edge : colours.paper;
        pen.lineWidth = Math.min(2.2 * pixel, head.categories[category].reach / 4);
        pen.stroke(path);
    }));
}

// A membrane whose dots the file does not have.
function drawMark(x, y, colour) {
    const side = 6 / camera.scale;
    pen.strokeStyle = colour;
    pen.lineWidth = 2 / camera.scale;
    pen.strokeRect(x - side, y - side, 2 * side, 2 * side);
}

function drawSelection() {
    for (const [object, colour, width] of [[state.hovered, colours.selection, 1.5], [state.selected, colours.selection_rim, 3]]) {
        if (object < 0 || !(poses[object].x === poses[object].x)) continue;
        const own = categoryOf(object), {x, y, angle} = poses[object];
        const larger = 1 + 3 / (camera.scale * own.radius);
        space.forEachImage(x, y, own.radius * larger, (dx, dy) => {
            bodyPath(own, x + dx, y + dy, angle, larger);
            pen.strokeStyle = colours.selection;
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
    const y = canvas.clientHeight - 22, text = `${Number(length.toPrecision(3))} mm`;
    pen.font = `12px ${FONT}`;
    pen.globalAlpha = PLATE;
    pen.fillStyle = colours.paper;
    pen.fillRect(10, y - 6, Math.max(length * camera.scale, pen.measureText(text).width) + 12, 28);
    pen.globalAlpha = 1;
    pen.fillStyle = colours.ink;
    pen.fillRect(16, y, length * camera.scale, 2.5);
    pen.fillText(text, 16, y + 16);
}

// Where objects would be a second later.
function velocities() {
    return Array.from(poses.keys(), (object) => {
        const [dx, dy] = run.track.velocity(object, state.index);
        return {...poses[object], dx, dy};
    }).filter(({x, dx}, object) => x === x && dx === dx && !categoryOf(object).membrane);
}

function labels() {
    const beside = colours.floor;
    return robots.filter((object) => poses[object].x === poses[object].x && head.objects[object][1] !== null).map((object) => ({
        ...poses[object], radius: categoryOf(object).radius, text: String(head.objects[object][1]),
        below: colourOf(object), beside,
    }));
}

function drawMarks() {
    const {velocities: arrows, labels: ids} = state.shows;
    if (arrows) drawArrows({pen, camera, space, colour: colours.contrastTo(colours.floor)}, velocities());
    if (ids) drawLabels({pen, camera, space, colours}, labels());
}

// Returns what the colours of the heat map mean; null: there is none.
function draw() {
    const ratio = canvas.width / Math.max(canvas.clientWidth, 1);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.fillStyle = colours.paper;
    pen.fillRect(0, 0, canvas.clientWidth, canvas.clientHeight);
    const scale = camera.scale * ratio;
    const [left, top] = camera.toScreen(0, 0);
    pen.setTransform(scale, 0, 0, scale, left * ratio, top * ratio);
    pen.save();
    pen.clip(floor, "evenodd");
    drawFloor();
    const heat = drawHeatMap();
    drawWalls();
    drawLamps();
    if (state.shows.trails) drawTrails(scene);
    if (state.shows.links === "below") drawLinks(scene);
    drawGlows();
    if (!space.isPeriodic) pen.restore();
    drawMembranes();
    drawBodies();
    if (state.shows.links === "above") drawLinks(scene);
    if (space.isPeriodic) {
        drawSelection();
        pen.restore();
    }
    pen.strokeStyle = colours.wall;
    pen.lineWidth = 3 / camera.scale;
    pen.lineJoin = "round";
    pen.stroke(floor);
    if (!space.isPeriodic) drawSelection();
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    drawMarks();
    if (state.shows.scale_bar) drawScaleBar();
    return heat;
}

return {
    draw, colourOf, categoryOf, velocities, labels,
    linkedPairs: () => linkedPairs(scene),
    placedLinks: () => placedLinks(scene),
};
}
