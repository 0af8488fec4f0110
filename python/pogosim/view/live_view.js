// A run that goes on, as its messages tell it: the view, and the controls that only such a run has.

const MOST_LINES = 500;  // of messages

// Shows a run in the elements of view.html and of live_panels.html and live_controls.html.
//
// root: the document, or a shadow root, that has these elements.
// send: sends a message, a map, to the run.
// Returns: take(message), for each message of the run: a map, or a DataView of bytes; end().
function liveView(root, send) {
const element = (id) => root.getElementById(id);
const ended = new AbortController();
let view = null, run = null, player = null, head = null, steers = true;
let kept = {};  // how the next run starts, and its camera
let status = null;  // the last one that came
let timer = 0;  // hides the notice

const listen = (target, type, heard) => target.addEventListener(type, heard, {signal: ended.signal});

function tell(text) {
    const notice = element("notice");
    notice.textContent = text;
    notice.hidden = !text;
    clearTimeout(timer);
    timer = setTimeout(() => { notice.hidden = true; }, 6000);
}

const shownProblem = (text) => {
    element("problem").textContent = text;
    element("problem").hidden = !text;
};

// ---- messages

function takeBytes(data) {
    if (!run) return;
    if (data.getUint8(0) === LIGHT) {
        run.setLight(new Uint8Array(data.buffer, data.byteOffset + 2, data.byteLength - 2));
        view?.redraw();
        return;
    }
    const number = run.add(data);
    send({do: "shown", frame: number});
    if (view) return view.setTime(view.state.time);  // a paused run has a new record of that time, as after a drag
    player = new LivePlayer(run, act);
    player.keys = {...player.keys, p: () => toggle("settings", "adjust"), m: () => toggle("messages", "lines"), s: savePicture};
    run.start = {...run.start, ...kept.start};
    view = swarmView(root, run, player);
    if (kept.camera) Object.assign(view.camera, kept.camera);
    if (status) takeStatus(status);
    ready?.(view);
}

// Starts with another run, with the same camera and switches as before.
function begin(message) {
    const isSame = head && JSON.stringify(head.objects) === JSON.stringify(message.head.objects);
    kept = {};
    if (view) {
        const {camera} = view, chosen = view.chosen();
        kept.start = {speed: player.speed,
                      view: isSame ? chosen : {...chosen, color_by: "", heat_map: "", follow: undefined}};
        if (isSame && !camera.fitted) kept.camera = {x: camera.x, y: camera.y, scale: camera.scale, fitted: false};
        view.end();
    }
    head = message.head;
    run = new LiveRun(head);
    view = null;
}

function takeStatus(message) {
    status = message;
    steers = message.steers;
    shownProblem(message.problem || (message.closed ? "The simulation is closed." : ""));
    element("viewers").textContent = message.viewers > 1 ? `${message.viewers} viewers` : "";
    element("steer").hidden = message.steers || !message.maySteer;
    for (const id of ["step", "reset", "play"]) element(id).disabled = !steers || message.closed;
    if (!view) return;
    player.isPlaying = message.playing;
    player.speed = message.speed ?? Infinity;
    element("speed").value = String(player.speed);
    element("title").textContent = head.title + (message.over ? " – the run is over" : "");
    view.showPlaying();
}

const TAKE = {
    head: begin,
    status: takeStatus,
    robot: ({object, values}) => {
        if (!view || object !== view.state.selected) return;
        run.robot = {object, values};
        view.redraw();
    },
    links: ({links}) => {
        run.bodyLinks = links;
        view?.redraw();
    },
    settings: showSettings,
    refused: ({message}) => tell(message),
    said: ({lines}) => addLines(lines),
};

// ---- settings

function showSettings({parameters, lamps}) {
    const names = Object.keys(parameters);
    element("parameters").replaceChildren(...names.map((name) => parameterLine(name, parameters[name])));
    if (!names.length) element("parameters").textContent = "The configuration has no numbers under parameters.";
    element("lamps").replaceChildren(...lamps.map(lampLine));
    if (!lamps.length) element("lamps").textContent = "There are none.";
}

function input(type, values) {
    return Object.assign(document.createElement("input"), {type, ...values});
}

function line(name, ...inputs) {
    const label = document.createElement("label");
    const text = document.createElement("span");
    text.textContent = name;
    label.className = "setting";
    label.append(text, ...inputs);
    return label;
}

// A slider around the value that the configuration gave, and a field for any other.
function numberInputs(name, value, low, high, changed) {
    const step = Number.isInteger(value) && Math.abs(value) > 4 ? 1 : "any";
    const slider = input("range", {min: low, max: high, step, value});
    const field = input("number", {step: "any", value});
    slider.setAttribute("aria-label", name);
    field.setAttribute("aria-label", `${name}, as a number`);
    listen(slider, "input", () => { field.value = String(Number(Number(slider.value).toPrecision(4))); });
    listen(slider, "change", () => changed(Number(field.value)));
    listen(field, "change", () => field.value !== "" && changed(Number(field.value)));
    return [slider, field];
}

function parameterLine(name, value) {
    const set = (to) => act({do: "set", name, value: to});
    if (typeof value === "boolean") {
        const box = input("checkbox", {checked: value});
        listen(box, "change", () => set(box.checked));
        return line(name, box);
    }
    const number = Number(value), reach = Math.abs(number) * 2 || 1;
    return line(name, ...numberInputs(name, number, number < 0 ? -reach : 0, reach, set));
}

function lampLine({name, on, intensity}, lamp) {
    const state = {on, intensity};
    const set = () => act({do: "lamp", lamp, ...state});
    const box = input("checkbox", {checked: on});
    box.setAttribute("aria-label", `${name} shines`);
    listen(box, "change", () => { state.on = box.checked; set(); });
    const inputs = numberInputs(`intensity of ${name}`, intensity, 0, Math.max(2, 2 * intensity), (to) => {
        state.intensity = to;
        set();
    });
    return line(name, box, ...inputs);
}

function toggle(panel, button) {
    const is = element(panel);
    is.hidden = !is.hidden;
    element(button).setAttribute("aria-expanded", String(!is.hidden));
}

function addLines(lines) {
    element("lines").hidden = false;
    const messages = element("messages");
    const isAtEnd = messages.scrollTop + messages.clientHeight >= messages.scrollHeight - 4;
    messages.append(...lines.map((text) => Object.assign(document.createElement("div"), {textContent: text})));
    while (messages.childElementCount > MOST_LINES) messages.firstElementChild.remove();
    if (isAtEnd) messages.scrollTop = messages.scrollHeight;
}

// ---- pictures

function save(blob, name) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

function savePicture() {
    if (!view) return;
    view.draw();
    element("arena").toBlob((blob) => save(blob, `swarm_${view.state.time.toFixed(2)}s.png`));
}

let recorder = null;

function toggleFilm() {
    if (recorder) return recorder.stop();
    if (!view || !window.MediaRecorder) return tell("This browser cannot record films.");
    const pieces = [];
    recorder = new MediaRecorder(element("arena").captureStream(30), {videoBitsPerSecond: 8e6});
    let bytes = 0;
    recorder.ondataavailable = ({data}) => {
        pieces.push(data);
        bytes += data.size;
        element("film").title = `Recorded: ${Math.round(bytes / 1000)} kB. Press again to save it`;
    };
    recorder.onstop = () => {
        const kind = recorder.mimeType.includes("mp4") ? "mp4" : "webm";
        save(new Blob(pieces, {type: recorder.mimeType}), `swarm.${kind}`);
        recorder = null;
        element("film").setAttribute("aria-pressed", "false");
        element("film").title = "Film what is seen, until it is pressed again";
    };
    recorder.start(1000);
    element("film").setAttribute("aria-pressed", "true");
}

// ---- start

// Asks for a change of the run, which only one that steers may.
function act(message) {
    const changes = !["select", "columns", "steer"].includes(message.do);
    if (changes && !steers) return tell("Another viewer steers this run.");
    send(message);
}

listen(element("step"), "click", () => act({do: "step", steps: 1}));
listen(element("reset"), "click", () => act({do: "reset"}));
listen(element("newest"), "click", () => view && player.seek(player.newest));
listen(element("adjust"), "click", () => toggle("settings", "adjust"));
listen(element("lines"), "click", () => toggle("messages", "lines"));
listen(element("save_picture"), "click", savePicture);
listen(element("film"), "click", toggleFilm);
listen(element("steer"), "click", () => send({do: "steer"}));
const follow = setInterval(() => {
    if (!view) return;
    element("newest").hidden = player.follows;
    view.showKey();
}, 300);
let ready = null;

return {
    take: (message) => message instanceof DataView ? takeBytes(message) : TAKE[message.kind]?.(message),
    get view() { return view; },
    get run() { return run; },
    tell,
    shownProblem,
    // Resolves with the view once there is one.
    ready: new Promise((resolve) => { ready = resolve; }),
    end: () => {
        clearInterval(follow);
        ended.abort();
        view?.end();
    },
};
}
