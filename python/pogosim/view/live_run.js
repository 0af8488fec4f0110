// A run that goes on: frames as they come, see frames.py, and the player that steers it.

const MOST_CELLS = 6e6;  // poses that are kept, over all times
const FRAME = 1, LIGHT = 2;
const COLUMN = 3;  // number of the first table of a column

// The tables of a frame, which become those of the next one.
class FrameReader {
    constructor(objects, parts) {
        const table = (rows, columns) => ({rows, columns, codes: new Uint16Array(rows * columns)});  // column by column
        this.tables = [table(objects, 3), table(objects, 2), table(parts, 2), table(objects, 2), table(objects, 2)];
        this.columns = [0, 0];
    }

    // data: a DataView of the message. Returns {number, time, columns}; the tables are those of this frame then.
    read(data) {
        const columns = [data.getUint16(2, true), data.getUint16(4, true)];
        columns.forEach((column, i) => {
            if (column !== this.columns[i]) this.tables[COLUMN + i].codes.fill(0);
        });
        this.columns = columns;
        let at = 18;
        this.tables.forEach((table, number) => {
            if (number < COLUMN || columns[number - COLUMN]) at = this.change(table, data, at);
        });
        return {number: data.getUint32(6, true), time: data.getFloat64(10, true), columns};
    }

    change({rows, columns, codes}, data, at) {
        const changed = [];
        for (let row = 0; row < rows; row++) if (data.getUint8(at + (row >> 3)) >> (row & 7) & 1) changed.push(row);
        at += (rows + 7) >> 3;
        const count = changed.length;
        for (let column = 0; column < columns; column++, at += 2 * count) {
            for (let i = 0; i < count; i++) {
                codes[column * rows + changed[i]] += data.getUint8(at + i) + 256 * data.getUint8(at + count + i);
            }
        }
        return at;
    }

    // The value of 32 bits of a table of two columns.
    bits(table, row) {
        const {rows, codes} = this.tables[table];
        return codes[row] * 65536 + codes[rows + row];
    }
}

// Poses of so many things, record by record.
class GrowingTrack extends Track {
    constructor(times, space, count, box) {
        super(times, space);
        Object.assign(this, {count, box, records: []});
        this.arrivals = new WeakMap();  // of records of which another one of the same time came before: that one
    }

    column(codes, number, low, high) {
        const {count} = this;
        return Float32Array.from(codes.subarray(number * count, (number + 1) * count), (code) => decoded(code, low, high));
    }

    add(codes, hasHeadings) {
        const [low, high] = this.box;
        this.records.push([0, 1].map((axis) => this.column(codes, axis, low[axis], high[axis])));
        if (hasHeadings) this.records[this.records.length - 1].push(this.column(codes, 2, -Math.PI, Math.PI));
    }

    x(object, index) { return this.records[index][0][object]; }
    y(object, index) { return this.records[index][1][object]; }
    angle(object, index) { return this.records[index][2] ? this.records[index][2][object] : NaN; }

    arrival(object, index) {
        const [x, y] = this.arrivals.get(this.records[index]) ?? this.records[index];
        return [x[object], y[object]];
    }

    // The last record takes the place of another one of the same time.
    replace(other) {
        this.arrivals.set(this.records[this.records.length - 1], this.arrivals.get(other) ?? other);
    }
}

class LiveRun {
    constructor(head) {
        this.head = head;
        this.start = {speed: 1, view: head.view};
        this.space = new Space(head);
        this.times = [];
        this.leds = [];
        this.values = [];  // record by record: values of columns, by the numbers of these
        this.track = new GrowingTrack(this.times, this.space, head.objects.length, head.poseBox);
        this.dots = head.membranes ? new GrowingTrack(this.times, this.space, head.membranes.dots, head.poseBox) : null;
        this.reader = new FrameReader(head.objects.length, head.membranes ? head.membranes.dots : 0);
        this.bodyLinks = head.bodyLinks;
        this.version = 0;
        this.light = null;
        this.robot = {object: -1, values: {}};
        this.colours = new Colours(head.palette);
        this.columns = [this.ledColumn(), ...head.columnNames.map((name, i) => this.askedColumn(name, i + 1))];
        const poses = {x: {low: head.low[0], high: head.high[0]}, y: {low: head.low[1], high: head.high[1]}};
        const names = new Set(this.columns.map((column) => column.name));
        this.columns.push(...columnsOfPoses(this, poses).filter((column) => !names.has(column.name)));
        this.most = Math.max(Math.floor(MOST_CELLS / (head.objects.length + 1)), 200);
    }

    ledColumn() {
        const value = (object, index) => this.leds[index][object];
        return {
            name: "LED", led: true, base: true, isListed: true,
            value: (object, index) => value(object, index) > 0xffffff ? null
                : `#${value(object, index).toString(16).padStart(6, "0")}`,
            colour: (object, index) => this.colours.ofLed(value(object, index)),
        };
    }

    // A column whose values come with frames when it is asked for; its colours go as far as its values did.
    askedColumn(name, number) {
        const valueAt = (object, index) => {
            const values = this.values[index].get(number);
            return values ? values[object] : NaN;
        };
        return computedColumn(this.colours, name, valueAt, Infinity, -Infinity, name === "angle" ? "angle" : "number");
    }

    // Takes a frame in; returns its number.
    add(data) {
        const {number, time, columns} = this.reader.read(data);
        if (time < this.times[this.times.length - 1]) this.forget(0);  // the run went back to a state
        const last = this.times.length - 1, other = time === this.times[last] ? this.track.records[last] : null;
        if (other) this.forget(last);
        if (this.times.length >= this.most) this.forget(1, true);
        const count = this.head.objects.length;
        this.version++;
        this.times.push(time);
        this.track.add(this.reader.tables[0].codes, true);
        if (other) this.track.replace(other);
        if (this.dots) this.dots.add(this.reader.tables[2].codes, false);
        this.leds.push(Uint32Array.from({length: count}, (_, object) => this.reader.bits(1, object)));
        this.values.push(new Map(columns.flatMap((own, i) => own ? [[own, this.readColumn(own, COLUMN + i)]] : [])));
        return number;
    }

    readColumn(number, table) {
        const bits = Uint32Array.from({length: this.head.objects.length}, (_, object) => this.reader.bits(table, object));
        const values = new Float32Array(bits.buffer);
        // Numbers of columns count from 1: place 0 is the LED.
        const own = this.columns[number];
        for (const value of values) {
            if (!Number.isFinite(value)) continue;
            own.from = Math.min(own.from, value);
            own.to = Math.max(own.to, value);
        }
        return values;
    }

    // Forgets the records from one on, or the first ones.
    forget(count, fromFront = false) {
        const records = [this.times, this.track.records, this.leds, this.values, ...(this.dots ? [this.dots.records] : [])];
        for (const own of records) own.splice(fromFront ? 0 : count, fromFront ? count : Infinity);
    }

    setLight(levels) {
        const isDark = levels.every((level) => level === 0);
        this.light = isDark ? null : new Light(this.head.lightCells, levels);
    }

    lightAt() {
        return this.light;
    }

    wallColour(wall, index) {
        const led = this.leds[index][wall.object];
        return this.colours.ofLed(led <= 0xffffff ? led : 0, this.colours.dark_wall);
    }

    moreValues(object) {
        return object === this.robot.object ? this.robot.values : {};
    }
}

// Steers a run by messages; send(message) sends one.
class LivePlayer {
    constructor(run, send) {
        Object.assign(this, {run, send, isPlaying: false, follows: true, before: null});
        this.speeds = [0.1, 0.25, 0.5, 1, 2, 4, 8, 16, 32, Infinity];
        this.speed = 1;
        this.keys = {
            n: () => this.send({do: "step", steps: 1}),
            r: () => this.send({do: "reset"}),
        };
    }

    attach(view) {
        this.view = view;
    }

    toggle() {
        this.follows = true;
        this.send({do: this.isPlaying ? "pause" : "play"});
    }

    setSpeed(speed) {
        if (speed === this.speed) return;
        this.speed = speed;
        this.send({do: "speed", value: speed === Infinity ? null : speed});
    }

    get newest() {
        return this.run.times[this.run.times.length - 1];
    }

    // Looks back, or at the newest record again.
    seek(time) {
        this.follows = time >= this.newest;
        this.view.setTime(time);
        this.view.showPlaying();
    }

    step(records) {
        const {times} = this.run;
        const to = this.view.state.index + records;
        if (to >= times.length && this.follows && !this.isPlaying) return this.send({do: "step", steps: records});
        this.seek(times[Math.min(Math.max(to, 0), times.length - 1)]);
    }

    // Follows the newest record, smoothly: frames come in jerks.
    tick(now) {
        const {state} = this.view;
        const late = this.newest - state.time;
        if (this.follows && late !== 0) {
            const share = this.before === null ? 1 : 1 - Math.exp(-(now - this.before) / 40);
            this.view.setTime(this.isPlaying && late > 0 ? state.time + share * late : this.newest);
        }
        this.before = now;
    }

    select(object) {
        this.run.robot = {object: -1, values: {}};
        this.send({do: "select", object});
    }

    // Asks for the values of two columns with each frame, for the colours and the heat map. What the page computes itself,
    // such as x, is not asked for.
    showColumns(names) {
        const asked = names.map((name) => this.run.head.columnNames.includes(name) ? name : null);
        if (JSON.stringify(asked) === JSON.stringify(this.asked)) return;
        this.asked = asked;
        this.send({do: "columns", color_by: asked[0], heat_map: asked[1] === asked[0] ? null : asked[1]});
    }

    drag(object, x, y) {
        this.send({do: "drag", object, x, y});
    }
}
