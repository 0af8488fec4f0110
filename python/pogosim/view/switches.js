// The switches of a view: the inputs of the class `switch` in view.html. The id of each is a key of the section `view`, which
// sets it at the start; without that key it is as in view.html. `data-key` is its key on the keyboard, that of the window where
// browsers allow it, and its title is its line in the help.

class Switches {
    // root: the document, or a shadow root. shows: becomes what they say, by their names. listen(target, type, heard): calls
    // heard() until the view ends. changed(name): one has changed.
    constructor(root, shows, listen, changed) {
        this.inputs = [...root.querySelectorAll(".switch")];
        Object.assign(this, {shows, changed});
        for (const input of this.inputs) {
            listen(input, "change", () => this.set(input.id, input.type === "checkbox" ? input.checked : input.value));
        }
        root.getElementById("switch_keys").replaceChildren(
            ...this.inputs.filter((input) => input.dataset.key && input.title).flatMap((input) =>
                [["dt", input.dataset.key], ["dd", input.title]].map(([tag, text]) =>
                    Object.assign(document.createElement(tag), {textContent: text}))));
    }

    // value: undefined: as in view.html.
    set(name, value) {
        const input = this.inputs.find((own) => own.id === name);
        if (input.type === "checkbox") {
            input.checked = this.shows[name] = value ?? input.defaultChecked;
        } else {
            const choices = [...input.options].map((option) => option.value);
            input.value = this.shows[name] = choices.includes(value) ? value : choices[0];
        }
        this.changed(name);
    }

    begin(viewOptions) {
        for (const {id} of this.inputs) this.set(id, viewOptions[id]);
    }

    // Returns what keys do, by the keys. Several boxes of a key go off if any is on.
    keys() {
        const press = (key) => {
            const inputs = this.inputs.filter((input) => input.dataset.key === key), [first] = inputs;
            const next = first.type === "checkbox" ? !inputs.some((own) => own.checked)
                : first.options[(first.selectedIndex + 1) % first.options.length].value;
            for (const {id} of inputs) this.set(id, next);
        };
        const keys = this.inputs.map((input) => input.dataset.key).filter(Boolean);
        return Object.fromEntries(keys.map((key) => [key.length === 1 ? key.toLowerCase() : key, () => press(key)]));
    }
}
