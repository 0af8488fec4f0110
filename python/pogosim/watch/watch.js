// The page of `pogosim watch`: a live run by a websocket of the server that the page comes from.

const RETRY_MS = [500, 1000, 2000, 4000];

function watch() {
    const address = new URL("live" + location.search, location.href);
    address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    let socket = null, tries = 0;
    const live = liveView(document, (message) => {
        if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
    });

    function connect() {
        socket = new WebSocket(address);
        socket.binaryType = "arraybuffer";
        socket.onopen = () => { tries = 0; };
        socket.onmessage = ({data}) => live.take(typeof data === "string" ? JSON.parse(data) : new DataView(data));
        socket.onclose = ({reason}) => {
            live.shownProblem(reason || "The connection is lost; trying again ...");
            if (!reason) setTimeout(connect, RETRY_MS[Math.min(tries++, RETRY_MS.length - 1)]);
        };
    }

    connect();
    return live;
}

window.live = watch();
