// Mouse and fingers on the picture: select, move objects, move and zoom the picture.

const SLACK = {mouse: 3, pen: 3, touch: 14};  // pixels beside an object that still hit it
const CLICK_PX = 4;  // a pointer that has moved less has clicked

// camera: moved and zoomed. target: isActive(), whether the wheel zooms; objectAt(x, y, slack), -1: none; select(object);
// hover(object); drag(object, x, y), mm, or undefined if objects cannot be moved; release(), before the picture moves; redraw().
function listenToPointers(canvas, camera, listen, target) {
    const down = new Map();  // where the pointers are that are down, by their ids
    let drag = null;
    const place = (event) => [event.offsetX, event.offsetY];
    const middle = () => [0, 1].map((axis) => [...down.values()].reduce((sum, at) => sum + at[axis], 0) / down.size);
    const spread = () => {
        const [[x, y], [toX, toY]] = down.values();
        return Math.max(Math.hypot(toX - x, toY - y), 1);
    };
    const shift = (from, to) => camera.moveTo(camera.x - (to[0] - from[0]) / camera.scale,
                                              camera.y - (to[1] - from[1]) / camera.scale);

    listen(canvas, "wheel", (event) => {
        if (!target.isActive()) return;
        event.preventDefault();
        camera.zoom(Math.exp(-event.deltaY * (event.deltaMode ? 0.03 : 0.0015)), ...place(event));
        target.redraw();
    }, {passive: false});

    listen(canvas, "pointerdown", (event) => {
        const at = place(event);
        down.set(event.pointerId, at);
        canvas.setPointerCapture(event.pointerId);
        const slack = SLACK[event.pointerType] ?? SLACK.mouse;
        const isMovable = target.drag && event.pointerType !== "touch";
        drag = {at, slack, object: isMovable ? target.objectAt(...at, slack) : -1, moved: down.size > 1};
    });

    listen(canvas, "pointermove", (event) => {
        const at = place(event), before = down.get(event.pointerId);
        if (!before) {
            if (event.pointerType === "touch") return;
            const object = target.objectAt(...at, SLACK.mouse);
            target.hover(object);
            canvas.style.cursor = object < 0 ? "default" : "pointer";
            return;
        }
        if (down.size > 1) {  // two fingers hold the picture
            const [from, width] = [middle(), spread()];
            down.set(event.pointerId, at);
            target.release();
            shift(from, middle());
            camera.zoom(spread() / width, ...middle());
        } else {
            drag.moved = drag.moved || Math.hypot(at[0] - drag.at[0], at[1] - drag.at[1]) > CLICK_PX;
            if (!drag.moved) return;
            down.set(event.pointerId, at);
            if (drag.object >= 0) {
                target.drag(drag.object, ...camera.toArena(...at));
            } else {
                target.release();
                shift(before, at);
            }
        }
        target.redraw();
    });

    const end = (event) => {
        down.delete(event.pointerId);
        if (!down.size) drag = null;
    };
    listen(canvas, "pointerup", (event) => {
        if (drag && !drag.moved) target.select(target.objectAt(...place(event), drag.slack));
        end(event);
    });
    listen(canvas, "pointercancel", end);
    listen(canvas, "pointerleave", () => target.hover(-1));
}
