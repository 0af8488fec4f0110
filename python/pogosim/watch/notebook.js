// A live run in a cell of a notebook, by anywidget.

let views = 0;

function render({model, el}) {
    const id = `${Date.now()}-${++views}`;
    const box = document.createElement("div");
    const root = box.attachShadow({mode: "open"});
    root.innerHTML = `<style>${model.get("css")}</style>
        <div class="view" style="height: ${model.get("height")}px">${model.get("elements")}</div>`;
    box.hidden = true;
    el.replaceChildren(box);

    const live = liveView(root, (message) => model.send({view: id, message}));
    // The still picture beside it is for saved notebooks.
    const hiding = document.createElement("style");
    const still = `.${model.get("still")}`;
    hiding.textContent = `${still}, .jp-OutputArea-child:has(${still}) { display: none !important; }`;
    const begin = () => {
        box.hidden = false;
        document.head.append(hiding);
    };
    const take = (content, buffers) => {
        if (content.to !== id) return;
        if (box.hidden) begin();
        live.take(buffers.length ? buffers[0] : content.message);
    };
    model.on("msg:custom", take);
    model.send({view: id, message: {do: "join"}});
    box.live = live;  // for programs that drive the page

    return () => {
        hiding.remove();
        model.off("msg:custom", take);
        live.end();
        model.send({view: id, message: {do: "leave"}});
    };
}

export default {render};
