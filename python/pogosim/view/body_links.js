// Links that hold bodies together: springs, rods and hinges. scene: see painter.js.

// Where links between bodies are now, as in body_links.py: those that hold, with their load from -1 to 1.
function placedLinks({run: {bodyLinks: links, space}, poses, state}) {
    const placed = [];
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
        const [dx, dy] = space.nearestImage(toX - x, toY - y);
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

function tensionColour(colours, load) {
    const [from, to] = [colours.link_at_rest, load < 0 ? colours.link_pushed : colours.link_pulled].map(channelsOf);
    return hexOf(mixed(from, to, Math.abs(load)));
}

function drawDot({run: {colours}, pen, camera}, x, y, radius, colour) {
    pen.beginPath();
    pen.arc(x, y, (radius + 0.6) / camera.scale, 0, 2 * Math.PI);
    pen.fillStyle = colours.edge;
    pen.fill();
    pen.beginPath();
    pen.arc(x, y, radius / camera.scale, 0, 2 * Math.PI);
    pen.fillStyle = colour;
    pen.fill();
}

function drawBodyLinks(scene) {
    const {run: {colours, space}, pen, camera} = scene;
    pen.lineCap = "round";
    for (const {x, y, dx, dy, kind, isPinned, load} of placedLinks(scene)) {
        const colour = tensionColour(colours, load);
        space.forEachImage(x + dx / 2, y + dy / 2, Math.hypot(dx, dy) / 2 + 4 / camera.scale, (ox, oy) => {
            const [px, py] = [x + ox, y + oy];
            if (kind === "hinge") return drawDot(scene, px, py, 3.6, colour);
            const width = kind === "rod" ? 3 : 2;
            for (const [own, extra] of [[colours.edge, 1.2], [colour, 0]]) {
                pen.strokeStyle = own;
                pen.lineWidth = (width + extra) / camera.scale;
                pen.beginPath();
                pen.moveTo(px, py);
                pen.lineTo(px + dx, py + dy);
                pen.stroke();
            }
            if (isPinned) drawDot(scene, px + dx, py + dy, 2.6, colour);
        });
    }
}
