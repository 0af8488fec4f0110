// What is written over the objects: their ids, and where they go. pen: in pixels of the page.

const ARROW = {width: 1.3, head: 4.5, halfWidth: 2.2, least: 1.5};  // the head in widths of the line
const LABEL = {least: 9, largest: 60, inside: 1.8};  // pixels; share of the radius
const FONT = "system-ui, 'DejaVu Sans', sans-serif";

function drawArrow(pen, from, to) {
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]], size = Math.hypot(dx, dy);
    if (!(size > ARROW.least)) return;
    const [u, v] = [dx / size, dy / size];
    const head = Math.min(ARROW.head * ARROW.width, 0.6 * size), half = head * ARROW.halfWidth / ARROW.head;
    const foot = [to[0] - head * u, to[1] - head * v];
    pen.beginPath();
    pen.moveTo(...from);
    pen.lineTo(...foot);
    pen.stroke();
    pen.beginPath();
    pen.moveTo(...to);
    pen.lineTo(foot[0] - half * v, foot[1] + half * u);
    pen.lineTo(foot[0] + half * v, foot[1] - half * u);
    pen.fill();
}

// places: {x, y, dx, dy} of each arrow, mm.
function drawArrows({pen, camera, space, colour}, places) {
    pen.strokeStyle = pen.fillStyle = colour;
    pen.lineWidth = ARROW.width;
    pen.lineCap = "butt";
    for (const {x, y, dx, dy} of places) {
        space.forEachImage(x + dx / 2, y + dy / 2, Math.hypot(dx, dy) / 2, (ox, oy) =>
            drawArrow(pen, camera.toScreen(x + ox, y + oy), camera.toScreen(x + ox + dx, y + oy + dy)));
    }
}

// labels: {x, y, radius, text, below, beside} of each: mm, and the colours of the object and of what is beside it.
function drawLabels({pen, camera, space, colours}, labels) {
    pen.textBaseline = "middle";
    for (const {x, y, radius, text, below, beside} of labels) {
        const pixels = radius * camera.scale;
        const size = Math.round(Math.min(Math.max(pixels, LABEL.least), LABEL.largest));
        pen.font = `${size}px ${FONT}`;
        const isInside = pen.measureText(text).width < LABEL.inside * pixels;
        pen.textAlign = isInside ? "center" : "left";
        pen.fillStyle = colours.ofTextOn(isInside ? below : beside);
        space.forEachImage(x, y, radius, (dx, dy) => {
            const [px, py] = camera.toScreen(x + dx, y + dy);
            pen.fillText(text, isInside ? px : px + pixels + 1, py);
        });
    }
    pen.textAlign = "left";
    pen.textBaseline = "alphabetic";
}
