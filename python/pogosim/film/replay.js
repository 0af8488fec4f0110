// Shows the run whose tables are in the page.

async function start() {
    const element = (id) => document.getElementById(id);
    const head = JSON.parse(element("head").textContent);
    const tables = await readTables(element("data").textContent, shapesOfTables(head));
    const run = new RecordedRun(head, tables);
    return swarmView(document, run, new RecordedPlayer(run));
}

// What programs that drive the page may use.
function interfaceOf({run, player, state, painter, ...view}) {
    const {head} = run;
    return {
        get time() { return state.time; },
        get playing() { return player.isPlaying; },
        get frames() { return state.frames; },
        get selected() { return state.selected; },
        get hovered() { return state.hovered; },
        get chosen() { return view.chosen(); },
        get arrows() { return painter.velocities().map(({x, y, dx, dy}) => ({from: [x, y], to: [x + dx, y + dy]})); },
        get colouring() { return state.colouring.name; },
        get columns() { return run.columns.map((column) => column.name); },
        get links() { return painter.linkedPairs().map(({from, to}) => [from, to]); },
        get bodyLinks() {
            return painter.placedLinks().map(({x, y, dx, dy, kind, load}) =>
                ({from: [x, y], to: [x + dx, y + dy], kind, load}));
        },
        count: head.objects.length,
        times: head.times,
        play: () => player.play(true),
        pause: () => player.play(false),
        setTime: view.setTime,
        colourBy: view.colourBy,
        select: view.select,
        fit: view.fit,
        valuesOf: view.valuesOf,
        colourOf: view.colourOf,
        redraw: view.draw,
        object: (category, id) => head.objects.findIndex(([own, number]) =>
            head.categories[own].name === category && number === id),
        pose: (object) => ({...view.poses[object]}),
        screen: (object) => view.camera.toScreen(view.poses[object].x, view.poses[object].y),
    };
}

window.replay = {};
window.replay.ready = start().then((view) => {
    Object.defineProperties(window.replay, Object.getOwnPropertyDescriptors(interfaceOf(view)));
}, (error) => {
    const problem = document.getElementById("problem");
    problem.textContent = `This browser cannot show the replay: ${error.message}`;
    problem.hidden = false;
    throw error;
});
