// Where objects have been. scene: see painter.js.

// Each trail in a few pieces, every one in the colour of its time, fading into the past.
function drawTrails({run, pen, camera, poses, state, categoryOf}) {
    const {space} = run, count = poses.length;
    const start = run.track.indexAt(state.time - state.tail_s);
    if (state.index <= start) return;
    const pieces = Math.min(count > 300 ? 5 : 12, state.index - start);
    const stride = Math.max(1, Math.round((state.index - start) / (count > 300 ? 25 : 120)));
    pen.lineCap = pen.lineJoin = "round";
    for (let piece = 0; piece < pieces; piece++) {
        const from = start + Math.floor((state.index - start) * piece / pieces);
        const to = start + Math.floor((state.index - start) * (piece + 1) / pieces);
        const freshness = (piece + 1) / pieces;
        const paths = new Map();  // by colour
        for (let object = 0; object < count; object++) {
            if (categoryOf(object).membrane) continue;
            const colour = state.colouring.colour(object, to);
            if (!paths.has(colour)) paths.set(colour, new Path2D());
            const path = paths.get(colour);
            let [x, y] = [NaN, NaN];
            const lead = (toX, toY) => {
                if (Math.abs(toX - x) <= space.size[0] / 2 && Math.abs(toY - y) <= space.size[1] / 2) {
                    path.lineTo(toX, toY);
                } else if (space.isPeriodic && x === x && toX === toX) {  // across the border: one line from either end
                    const [dx, dy] = space.nearestImage(toX - x, toY - y);
                    path.lineTo(x + dx, y + dy);
                    path.moveTo(toX - dx, toY - dy);
                    path.lineTo(toX, toY);
                } else {
                    path.moveTo(toX, toY);
                }
                [x, y] = [toX, toY];
            };
            for (let i = from; i < to; i += stride) lead(run.track.x(object, i), run.track.y(object, i));
            lead(run.track.x(object, to), run.track.y(object, to));
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
