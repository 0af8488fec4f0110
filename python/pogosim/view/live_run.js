// A run that goes on: frames as they come, see frames.py, and the player that steers it.

const LIVE_MISSING = 65535;
const LIVE_LEVELS = 65534;
const MOST_CELLS = 6e6;  // poses that are kept, over all times
const FRAME = 1, LIGHT = 2;

// The tables of a frame, which become those of the next one.
class FrameReader {
    constructor(objects, parts) {
        const table = (rows, columns) => ({rows, columns, codes: new Uint16Array(rows * columns)});  // column by column
        this.tables = [table(objects, 3), table(objects, 2), table(parts, 2), table(objects, 2)];
        this.column = 0;
    }

    // data: a DataView of the message. Returns {number, time, column}; the tables are those of this frame then.
    read(data) {
        const column = data.getUint16(2, true);
        if (column !== this.column) this.tables[3].codes.fill(0);
        this.column = column;
        let at = 16;
        this.tables.forEach((table, number) => {
            if (number < 3 || column) at = this.change(table, data, at);
        });
        return {number: data.getUint32(4, true), time: data.getFloat64(8, true), column};
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
    }

    decoded(codes, column, low, high) {
        const values = new Float32Array(this.count), scale = (high - low) / LIVE_LEVELS;
        for (let i = 0; i < this.count; i++) {
            const code = codes[column * this.count + i];
            values[i] = code === LIVE_MISSING ? NaN : low + scale * code;
        }
        return values;
    }

    add(codes, hasHeadings) {
        const [low, high] = this.box;
        this.records.push([0, 1].map((axis) => this.decoded(codes, axis, low[axis], high[axis])));
        if (hasHeadings) this.records[this.records.length - 1].push(this.decoded(codes, 2, -Math.PI, Math.PI));
    }

    x(object, index) { return this.records[index][0][object]; }
    y(object, index) { return this.records[index][1][object]; }
    angle(object, index) { return this.records[index][2] ? this.records[index][2][object] : NaN; }
}

// The values of LEDs on the screen, as led_brightness() in palette.py has them.
function ledColour(palette, packed) {
    if (!packed) return palette.dark_led;
    const [dimmest, brightest] = [palette.dimmest_led, palette.brightest_led];
    const [low, high] = [palette.dimmest_led_on_screen, palette.brightest_led_on_screen];
    const channel = (value) => {
        const share = Math.min(Math.max((value - dimmest) / (brightest - dimmest), 0), 1);
        return Math.round(value ? low + share * (high - low) : 0).toString(16).padStart(2, "0");
    };
    return `#${[packed >> 16, packed >> 8 & 255, packed & 255].map(channel).join("")}`;
}

class LiveRun {
    constructor(head) {
        this.head = head;
        this.start = {speed: 1, trails: false, links: false, colourBy: "LED"};
        this.space = new Space(head);
        this.times = [];
        this.leds = [];
        this.values = [];  // record by record: number of a column and its values, or null
        this.track = new GrowingTrack(this.times, this.space, head.objects.length, head.poseBox);
        this.dots = head.membranes ? new GrowingTrack(this.times, this.space, head.membranes.dots, head.poseBox) : null;
        this.reader = new FrameReader(head.objects.length, head.membranes ? head.membranes.dots : 0);
        this.bodyLinks = head.bodyLinks;
        this.light = null;
        this.robot = {object: -1, values: {}};
        this.colours = new Map();
        this.columns = [this.ledColumn(), ...head.columnNames.map((name, i) => this.askedColumn(name, i + 1))];
        const poses = {x: {low: head.low[0], high: head.high[0]}, y: {low: head.low[1], high: head.high[1]}};
        const names = new Set(this.columns.map((column) => column.name));
        this.columns.push(...columnsOfPoses(head, this.track, poses).filter((column) => !names.has(column.name)));
        this.most = Math.max(Math.floor(MOST_CELLS / (head.objects.length + 1)), 200);
    }

    colourOfLed(packed) {
        if (!this.colours.has(packed)) this.colours.set(packed, ledColour(this.head.palette, packed));
        return this.colours.get(packed);
    }

    ledColumn() {
        const value = (object, index) => this.leds[index][object];
        return {
            name: "LED", led: true, base: true, isListed: true,
            value: (object, index) => value(object, index) > 0xffffff ? null
                : `#${value(object, index).toString(16).padStart(6, "0")}`,
            colour: (object, index) => this.colourOfLed(value(object, index)),
        };
    }

    // A column whose values come with frames when it is asked for; its colours go as far as its values did.
    askedColumn(name, number) {
        const valueAt = (object, index) => {
            const record = this.values[index];
            return record && record.number === number ? record.values[object] : NaN;
        };
        return computedColumn(this.head, name, valueAt, Infinity, -Infinity, name === "angle" ? "angle" : "number");
    }

    // Takes a frame in; returns its number.
    add(data) {
        const {number, time, column} = this.reader.read(data);
        if (time < this.times[this.times.length - 1]) this.forget(0);  // the run went back to a state
        if (time === this.times[this.times.length - 1]) this.forget(this.times.length - 1);
        if (this.times.length >= this.most) this.forget(1, true);
        const count = this.head.objects.length;
        this.times.push(time);
        this.track.add(this.reader.tables[0].codes, true);
        if (this.dots) this.dots.add(this.reader.tables[2].codes, false);
        this.leds.push(Uint32Array.from({length: count}, (_, object) => this.reader.bits(1, object)));
        this.values.push(column ? this.readColumn(column, count) : null);
        return number;
    }

    readColumn(number, count) {
        const bits = Uint32Array.from({length: count}, (_, object) => this.reader.bits(3, object));
        const values = new Float32Array(bits.buffer);
        const own = this.columns[number];
        for (const value of values) {
            if (!Number.isFinite(value)) continue;
            own.from = Math.min(own.from, value);
            own.to = Math.max(own.to, value);
        }
        return {number, values};
    }

    // Forgets the records from one on, or the first ones.
    forget(count, fromFront = false) {
        const records = [this.times, this.track.records, this.leds, this.values, ...(this.dots ? [this.dots.records] : [])];
        for (const own of records) own.splice(fromFront ? 0 : count, fromFront ? count : Infinity);
    }

    setLight(levels) {
        const isDark = levels.every((level) => level === 0);
        this.light = isDark ? null : lightPicture(this.head.palette, this.head.lightCells, levels);
    }

    lightAt() {
        return this.light;
    }

    wallColour(wall, index) {
        const led = this.leds[index][wall.object];
        return led && led <= 0xffffff ? this.colourOfLed(led) : wall.dark;
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

    colourBy(name) {
        this.send({do: "column", name: this.run.head.columnNames.includes(name) ? name : null});
    }

    drag(object, x, y) {
        this.send({do: "drag", object, x, y});
    }
}
