// Browsers start no worker for a page that is read from a file. There, a hidden frame stands in for the one that searches.
if (location.protocol === "file:") {
    window.Worker = class extends EventTarget {
        constructor(url) {
            super();
            const base = new URL(url, document.baseURI);
            const waiting = [];
            const frame = document.createElement("iframe");
            frame.hidden = true;
            document.body.append(frame);
            const inside = frame.contentWindow;
            this.send = (data) => waiting.push(data);
            inside.postMessage = (data) => {
                const event = new MessageEvent("message", { data });
                this.dispatchEvent(event);
                this.onmessage?.(event);
            };
            const load = (address) =>
                new Promise((done, failed) => {
                    const script = inside.document.createElement("script");
                    script.src = new URL(address, base);
                    script.onload = done;
                    script.onerror = failed;
                    inside.document.body.append(script);
                });
            // The search loads its parts this way, and awaits them.
            inside.importScripts = (...addresses) =>
                addresses.reduce((before, address) => before.then(() => load(address)), Promise.resolve());
            load(base).then(() => {
                this.send = (data) => inside.dispatchEvent(new MessageEvent("message", { data }));
                waiting.forEach(this.send);
            });
        }

        postMessage(data) {
            this.send(data);
        }

        terminate() {}
    };
}
