// A run that is over: the tables of a page, and the player that shows them again.

// Undoes what packing.py does: text to tables of 16-bit codes, object by object.
async function readTables(packed, shapes) {
    const text = atob(packed);
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
function shapesOfTables(head) {
    const shapes = [];
    const count = head.objects.length;
    const poses = (own, rows, columns) => {
        for (const name of ["x", "y", "angle"]) shapes[own[name].table] = [rows, columns];
    };
    poses(head.poses, head.times.length, count);
    for (const column of head.columns) shapes[column.table] = [head.times.length, count];
    for (const [, table] of head.lights) shapes[table] = [1, head.lightCells * head.lightCells];
    if (head.membranes) poses(head.membranes.poses, head.membranes.times.length, head.membranes.dots);
    return shapes;
}

class RecordedTrack extends Track {
    constructor(tables, poses, times, space) {
        super(times, space);
        this.values = ["x", "y", "angle"].map((name) => {
            const {table, low, high} = poses[name];
            return Float32Array.from(tables[table], (code) => decoded(code, low, high));
        });
    }

    x(object, index) { return this.values[0][object * this.times.length + index]; }
    y(object, index) { return this.values[1][object * this.times.length + index]; }
    angle(object, index) { return this.values[2][object * this.times.length + index]; }
}

// A column of the data file: values, and the colours that stand for them.
class RecordedColumn {
    constructor(head, shown, codes, own) {
        Object.assign(this, own);
        Object.assign(this, {head, shown, codes, isListed: !own.base || own.led});
        if (own.values?.length === 0) [this.from, this.to] = [Infinity, -Infinity];
        this.lights = own.led ? own.labels.map((label) => parseInt(label.slice(1), 16)) : null;
    }

    code(object, index) {
        return this.codes[object * this.head.times.length + index];
    }

    value(object, index) {
        const code = this.code(object, index);
        if (code === MISSING) return null;
        if (this.labels) return this.labels[code];
        return this.values ? this.values[code] : decoded(code, this.low, this.high);
    }

    colour(object, index) {
        const code = this.code(object, index);
        if (code === MISSING) return this.shown.no_led;
        if (this.lights) return this.shown.ofLed(this.lights[code]);
        if (this.colours) return this.colours[code];
        return this.shown.ofValue(this.shades, this.value(object, index), this.from, this.to);
    }
}

class RecordedRun {
    // head: as replay.py makes it; tables: as readTables() returns them.
    constructor(head, tables) {
        this.head = head;
        this.start = {...head.start, view: head.view};
        this.space = new Space(head);
        this.times = Float64Array.from(head.times);
        this.track = new RecordedTrack(tables, head.poses, this.times, this.space);
        this.dots = head.membranes
            ? new RecordedTrack(tables, head.membranes.poses, Float64Array.from(head.membranes.times), this.space) : null;
        this.version = 0;
        this.bodyLinks = head.bodyLinks;
        this.colours = new Colours(head.palette);
        this.lights = head.lights.map(([from, table]) => ({from, light: new Light(head.lightCells, tables[table])}));
        this.columns = head.columns.map((own) => new RecordedColumn(head, this.colours, tables[own.table], own));
        const names = new Set(this.columns.map((column) => column.name));
        this.columns.push(...columnsOfPoses(this, head.poses).filter((column) => !names.has(column.name)));
    }

    lightAt(index) {
        return this.lights.filter(({from}) => from <= index).pop()?.light;
    }

    wallColour(wall, index) {
        const [, colour] = wall.colours.filter(([from]) => from <= index).pop() || wall.colours[0];
        return colour === null ? this.colours.dark_wall : this.colours.ofLight(colour);
    }
}

class RecordedPlayer {
    constructor(run) {
        Object.assign(this, {run, isPlaying: false, speed: 1, before: null, speeds: [0.1, 0.25, 0.5, 1, 2, 4, 8, 16, 32]});
        [this.first, this.last] = [run.times[0], run.times[run.times.length - 1]];
    }

    attach(view) {
        this.view = view;
    }

    play(on) {
        if (on && this.view.state.time >= this.last) this.view.setTime(this.first);
        this.isPlaying = on && this.last > this.first;
        this.before = null;
        this.view.showPlaying();
    }

    toggle() {
        this.play(!this.isPlaying);
    }

    setSpeed(speed) {
        this.speed = speed;
    }

    seek(time) {
        this.play(false);
        this.view.setTime(time);
    }

    step(records) {
        const {times} = this.run;
        this.seek(times[Math.min(Math.max(this.view.state.index + records, 0), times.length - 1)]);
    }

    tick(now) {
        if (!this.isPlaying) return;
        const {view} = this;
        if (this.before !== null) view.setTime(view.state.time + Math.min((now - this.before) / 1000, 0.25) * this.speed);
        this.before = now;
        view.redraw();
        if (view.state.time >= this.last) this.play(false);
    }
}
