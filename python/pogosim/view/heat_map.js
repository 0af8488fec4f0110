// A heat map: where robots are, or a value of those nearby. The field is that of src/render/heat_field.cpp, its colours those
// of heat_layer.cpp; their constants must stay the same.

const DEVIATION = 0.04;  // of the longer side of the arena
const CELLS_PER_DEVIATION = 2;
const REACH = 3.5;  // deviations; 0.2 % of a distribution lie beyond
const CERTAIN_WEIGHT = 0.3;  // of a robot in the middle of a cell
const FAINT_SHARE = 0.12;  // of the range: a density below fades into the floor
const HEAT_OPACITY = 0.85;
const DOTS_PER_CELL = 4;  // of its picture
const DENSITY = "density";

// The least round number that is not below.
function roundUp(value) {
    const power = 10 ** Math.floor(Math.log10(value));
    return power * ([1, 1.5, 2, 3, 4, 5, 6, 8].find((step) => step * power >= value * (1 - 1e-6)) ?? 10);
}

// Sums of the weights of robots around the middles of cells, and of their weighted values.
class HeatField {
    constructor(space) {
        this.space = space;
        this.cell = DEVIATION * Math.max(...space.size) / CELLS_PER_DEVIATION;  // mm
        [this.columns, this.rows] = space.size.map((size) => Math.max(Math.ceil(size / this.cell), 1));
        this.weight = new Float32Array(this.columns * this.rows);
        this.sums = new Float32Array(this.columns * this.rows);
        this.across = new Float32Array(this.columns * this.rows);  // of angles: the sines
    }

    // Adds a robot at a place, and at its images; value: of a number, or the cosine and sine of an angle.
    add(x, y, value, across = 0) {
        const reach = REACH * CELLS_PER_DEVIATION * this.cell;
        this.space.forEachImage(x, y, reach, (dx, dy) => this.addOnce(x + dx, y + dy, value, across));
    }

    addOnce(x, y, value, across) {
        const {cell, columns, rows, space: {low}} = this;
        const reach = REACH * CELLS_PER_DEVIATION;
        const range = (at, origin, count) => [Math.max(Math.floor((at - origin) / cell - reach), 0),
                                              Math.min(Math.floor((at - origin) / cell + reach + 1), count)];
        const fall = (index, at, origin) =>
            Math.exp(-0.5 * ((origin + (index + 0.5) * cell - at) / (CELLS_PER_DEVIATION * cell)) ** 2);
        const [left, right] = range(x, low[0], columns), [top, bottom] = range(y, low[1], rows);
        const beside = [];
        for (let column = left; column < right; column++) beside.push(fall(column, x, low[0]));
        for (let row = top; row < bottom; row++) {
            const down = fall(row, y, low[1]);
            for (let column = left; column < right; column++) {
                const weight = down * beside[column - left], at = row * columns + column;
                this.weight[at] += weight;
                this.sums[at] += weight * value;
                this.across[at] += weight * across;
            }
        }
    }

    // Robots per square metre, in each cell.
    density() {
        const deviation = CELLS_PER_DEVIATION * this.cell / 1000;
        return this.weight.map((weight) => weight / (2 * Math.PI * deviation ** 2));
    }

    // The field as an image. shadeOf(at) returns the colour of a dot ([red, green, blue]) and its opacity, 0 to 1; at(table)
    // gives it the value of a table of cells there, interpolated.
    picture(shadeOf) {
        const [width, height] = [this.columns * DOTS_PER_CELL, this.rows * DOTS_PER_CELL];
        const image = new ImageData(width, height);
        const place = (dot, count) => {
            const at = Math.min(Math.max((dot + 0.5) / DOTS_PER_CELL - 0.5, 0), count - 1), low = Math.floor(at);
            return [low, Math.min(low + 1, count - 1), at - low];
        };
        const columns = Array.from({length: width}, (_, dot) => place(dot, this.columns));
        for (let y = 0; y < height; y++) {
            const [above, below, down] = place(y, this.rows).map((row, i) => i < 2 ? row * this.columns : row);
            for (let x = 0; x < width; x++) {
                const [left, right, beside] = columns[x];
                const at = (table) => (1 - down) * ((1 - beside) * table[above + left] + beside * table[above + right])
                    + down * ((1 - beside) * table[below + left] + beside * table[below + right]);
                const [colour, opacity] = shadeOf(at);
                image.data.set(colour, 4 * (y * width + x));
                image.data[4 * (y * width + x) + 3] = Math.round(255 * HEAT_OPACITY * opacity);
            }
        }
        const canvas = new OffscreenCanvas(width, height);
        canvas.getContext("2d").putImageData(image, 0, 0);
        return canvas;
    }
}

// Makes the heat map of robots at their poses; column: of run.columns, null: the density.
// Returns {picture, width, height, name, from, to, shades}: the picture is as wide and high from the low corner on, mm.
function heatMap({space, colours, poses, column, index, robots}) {
    const field = new HeatField(space);
    const isAngle = column?.shades === "angle";
    for (const object of robots) {
        const {x, y} = poses[object];
        const value = column ? column.value(object, index) : 1;
        if (!(x === x) || typeof value !== "number" || !Number.isFinite(value)) continue;
        if (isAngle) field.add(x, y, Math.cos(value), Math.sin(value)); else field.add(x, y, value);
    }
    const shade = (kind, share) => shadeAt(colours.shadeChannels[kind], share);
    const size = {width: field.columns * field.cell, height: field.rows * field.cell};
    if (!column) {
        const density = field.density();
        const most = density.reduce((a, b) => Math.max(a, b), 0);
        const to = most > 0 ? roundUp(most) : 1;
        const picture = field.picture((at) => {
            const share = at(density) / to;
            return [shade("number", share), Math.min(share / FAINT_SHARE, 1)];
        });
        return {...size, picture, name: "robots per m2", from: 0, to, shades: "number"};
    }
    const {from, to} = column;
    const mean = (sums) => sums.map((sum, cell) => field.weight[cell] > 0 ? sum / field.weight[cell] : 0);
    const certainty = field.weight.map((weight) => Math.min(weight / CERTAIN_WEIGHT, 1));
    const [along, across] = [mean(field.sums), mean(field.across)];
    const picture = field.picture((at) => {
        if (!isAngle) return [shade("number", to > from ? (at(along) - from) / (to - from) : 0.5), at(certainty)];
        const [x, y] = [at(along), at(across)];
        return [shade("angle", Math.atan2(y, x) / (2 * Math.PI) + 0.5), at(certainty) * Math.hypot(x, y)];
    });
    return {...size, picture, name: column.name, from, to, shades: column.shades};
}
