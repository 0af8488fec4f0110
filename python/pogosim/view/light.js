// Light on the floor as a small picture, to be stretched over the arena.

class Light {
    // levels: 0 to 255, row by row.
    constructor(cells, levels) {
        Object.assign(this, {cells, levels, version: 0});
    }

    picture(colours) {
        if (this.version !== colours.version) {
            const lamplight = channelsOf(colours.lamplight), {cells} = this;
            this.shown = new OffscreenCanvas(cells, cells);
            this.version = colours.version;
            const image = new ImageData(cells, cells);
            this.levels.forEach((level, cell) =>
                image.data.set([...lamplight, Math.round(level * colours.brightest_lamplight)], 4 * cell));
            this.shown.getContext("2d").putImageData(image, 0, 0);
        }
        return this.shown;
    }
}
