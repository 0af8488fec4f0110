// The space in which objects are: the box of the arena, and the shortest ways in it.

class Space {
    constructor(head) {
        this.low = head.low;
        this.high = head.high;
        this.size = [head.high[0] - head.low[0], head.high[1] - head.low[1]];
        this.isPeriodic = head.periodic;
    }

    // The shortest of all images of an offset; in an arena with walls, the offset itself.
    nearestImage(dx, dy) {
        if (!this.isPeriodic) return [dx, dy];
        const [width, height] = this.size;
        return [dx - width * Math.round(dx / width), dy - height * Math.round(dy / height)];
    }

    wrapped(value, axis) {
        if (value < this.low[axis]) return value + this.size[axis];
        return value > this.high[axis] ? value - this.size[axis] : value;
    }

    // Calls draw(dx, dy) for every image of a place in a periodic arena that reaches into it; once elsewhere.
    forEachImage(x, y, reach, draw) {
        if (!this.isPeriodic) return draw(0, 0);
        const {low, high, size} = this;
        for (let i = -1; i <= 1; i++) {
            for (let j = -1; j <= 1; j++) {
                const [px, py] = [x + i * size[0], y + j * size[1]];
                if (px + reach < low[0] || px - reach > high[0] || py + reach < low[1] || py - reach > high[1]) continue;
                draw(i * size[0], j * size[1]);
            }
        }
    }
}

// Which part of the arena a canvas shows.
class Camera {
    constructor(canvas, space) {
        Object.assign(this, {canvas, space, x: 0, y: 0, scale: 1, fitted: true});  // mm; pixels of the page per mm
    }

    toScreen(x, y) {
        return [(x - this.x) * this.scale + this.canvas.clientWidth / 2,
                (y - this.y) * this.scale + this.canvas.clientHeight / 2];
    }

    toArena(px, py) {
        return [(px - this.canvas.clientWidth / 2) / this.scale + this.x,
                (py - this.canvas.clientHeight / 2) / this.scale + this.y];
    }

    // Shows the whole arena, or `zoom` times as large.
    fit(zoom = 1) {
        const margin = 46, {low, high, size} = this.space;
        const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
        this.scale = zoom * Math.max(Math.min((width - 32) / size[0], (height - 2 * margin) / size[1]), 1e-6);
        this.x = (low[0] + high[0]) / 2;
        this.y = (low[1] + high[1]) / 2;
        [this.fitted, this.zoomAtFit] = [true, zoom];
        this.hasSize = width > 0 && height > 0;  // in a part of a page that is not shown yet there is nothing to fit into
    }

    zoom(factor, px, py) {
        const [x, y] = this.toArena(px, py), {size} = this.space;
        const fitted = Math.min(this.canvas.clientWidth / size[0], this.canvas.clientHeight / size[1]);
        this.scale = Math.min(Math.max(this.scale * factor, fitted / 8), fitted * 400);
        this.moveTo(x - (px - this.canvas.clientWidth / 2) / this.scale, y - (py - this.canvas.clientHeight / 2) / this.scale);
    }

    moveTo(x, y) {
        [this.x, this.y, this.fitted] = [x, y, false];
    }
}
