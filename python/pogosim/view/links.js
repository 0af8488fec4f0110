// Links of communication: which robots hear each other. scene: see painter.js.

// Pairs of robots near enough to hear each other: max(range of a, range of b) + radius of a + radius of b.
function linkedPairs({run: {head, space}, poses, categoryOf}) {
    const talkers = [];
    let furthest = 0;
    for (let object = 0; object < poses.length; object++) {
        const own = categoryOf(object);
        if (!own.talks || !(poses[object].x === poses[object].x)) continue;
        talkers.push(object);
        if (own.range > 0) furthest = Math.max(furthest, own.range);
    }
    if (furthest <= 0) return [];
    const reach = furthest + 2 * Math.max(...head.categories.filter((own) => own.talks).map((own) => own.radius));
    const cells = [0, 1].map((axis) => Math.max(1, Math.min(Math.floor(space.size[axis] / reach), 1000)));
    const place = (value, axis) =>
        Math.min(Math.max(Math.floor((value - space.low[axis]) / space.size[axis] * cells[axis]), 0), cells[axis] - 1);
    const grid = new Map();
    const pairs = [];
    for (const object of talkers) {
        const {x, y} = poses[object];
        const [column, row] = [place(x, 0), place(y, 1)];
        const seen = new Set();
        for (let i = -1; i <= 1; i++) {
            for (let j = -1; j <= 1; j++) {
                let [c, r] = [column + i, row + j];
                if (space.isPeriodic) [c, r] = [(c + cells[0]) % cells[0], (r + cells[1]) % cells[1]];
                const key = r * 4096 + c;
                if (seen.has(key)) continue;
                seen.add(key);
                for (const other of grid.get(key) || []) {
                    const [dx, dy] = space.nearestImage(poses[other].x - x, poses[other].y - y);
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

function drawLinks(scene) {
    const {run: {colours}, pen, camera, poses} = scene;
    pen.strokeStyle = colours.link_by_all_emitters;
    pen.globalAlpha = 0.55;
    pen.lineWidth = 1.1 / camera.scale;
    pen.beginPath();
    for (const {from, to, dx, dy} of linkedPairs(scene)) {
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
