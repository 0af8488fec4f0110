// Where objects are at any time, between the times of a record. See Timeline.at() in timeline.py.

const MISSING = 65535;  // the code of what has no value
const LEVELS = 65534;  // the highest other code

// The number that a code of 16 bits stands for, see packing.py; NaN: there is none.
const decoded = (code, low, high) => code === MISSING ? NaN : low + (high - low) * code / LEVELS;

class Track {
    // times: ascending, s. Classes that extend this one know x(object, index), y and angle.
    constructor(times, space) {
        this.times = times;
        this.space = space;
    }

    // Number of the last time at or before a time.
    indexAt(time) {
        let first = 0, end = this.times.length;
        const slack = 1e-9 * Math.max(1, Math.abs(time));
        while (end - first > 1) {
            const middle = (first + end) >> 1;
            if (this.times[middle] <= time + slack) first = middle; else end = middle;
        }
        return first;
    }

    shareAt(time, index) {
        if (index + 1 >= this.times.length) return 0;
        const start = this.times[index];
        return Math.min(Math.max((time - start) / (this.times[index + 1] - start), 0), 1);
    }

    // How far an object moves from a record to the next one, mm, the shortest way. In an arena with walls, no robot moves half
    // the arena: one that has jumped stays where it was until it is elsewhere. As between() in timeline.py.
    step(object, from, [x, y] = this.place(object, from + 1)) {
        const {space} = this;
        const [dx, dy] = space.nearestImage(x - this.x(object, from), y - this.y(object, from));
        const isJump = Math.abs(dx) > space.size[0] / 2 || Math.abs(dy) > space.size[1] / 2;
        return isJump && !space.isPeriodic ? [0, 0] : [dx, dy];
    }

    place(object, index) { return [this.x(object, index), this.y(object, index)]; }

    // Where an object was by its own motion: a hand may have put it elsewhere since.
    arrival(object, index) { return this.place(object, index); }

    // Pose of an object, on the straight and shortest way between two times.
    at(object, index, share, pose) {
        const {space} = this;
        pose.x = this.x(object, index);
        pose.y = this.y(object, index);
        pose.angle = this.angle(object, index);
        if (share <= 0 || index + 1 >= this.times.length) return pose;
        const [dx, dy] = this.step(object, index);
        pose.x += share * dx;
        pose.y += share * dy;
        if (space.isPeriodic) {
            pose.x = space.wrapped(pose.x, 0);
            pose.y = space.wrapped(pose.y, 1);
        }
        const turn = this.angle(object, index + 1) - pose.angle;
        if (turn === turn) pose.angle += share * (turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI)));
        return pose;
    }

    // Velocity of an object at a record, mm/s: how it has moved since the record before; at the first one, how it moves until
    // the next; 0 if there is only one. As Timeline.velocities_at() in timeline.py.
    velocity(object, index) {
        if (this.times.length < 2) return [0, 0];
        const to = Math.max(index, 1), seconds = this.times[to] - this.times[to - 1];
        return this.step(object, to - 1, this.arrival(object, to)).map((way) => way / seconds);
    }
}

// A column that every run has, computed from what a record knows anyway.
function computedColumn(colours, name, valueOf, from, to, shades) {
    const own = {name, from, to, shades, value: valueOf};
    own.colour = (object, index) => {
        const value = valueOf(object, index);
        return value === null || value !== value ? colours.no_led : colours.ofValue(shades, value, own.from, own.to);
    };
    return own;
}

// robot_id, x, y and angle. poses: limits of x and y.
function columnsOfPoses({head, track, colours}, poses) {
    const ids = head.objects.map(([, id]) => id).filter((id) => id !== null);
    const [least, most] = [ids.reduce((a, b) => Math.min(a, b), Infinity), ids.reduce((a, b) => Math.max(a, b), -Infinity)];
    return [
        computedColumn(colours, "robot_id", (object) => head.objects[object][1], least, most, "number"),
        computedColumn(colours, "x", (object, index) => track.x(object, index), poses.x.low, poses.x.high, "number"),
        computedColumn(colours, "y", (object, index) => track.y(object, index), poses.y.low, poses.y.high, "number"),
        computedColumn(colours, "angle", (object, index) => track.angle(object, index), -Math.PI, Math.PI, "angle"),
    ];
}
