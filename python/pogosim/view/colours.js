// The colours of a view by its theme and palette, as in src/render/theme_colours.cpp: those of palette.json, and the circle of
// hues for directions.

const SHADES = 256;  // of the colours of values
const MOST_COLOURS = 4000;  // of LEDs that are kept
const TURN = ["#ff0000", "#ffff00", "#00ff00", "#00ffff", "#0000ff", "#ff00ff"];  // hues of directions

const channelsOf = (colour) => colour.match(/\w\w/g).map((text) => parseInt(text, 16));
const hexOf = (channels) => `#${channels.map((own) => Math.round(own).toString(16).padStart(2, "0")).join("")}`;
const mixed = (from, to, share) => from.map((own, i) => own + share * (to[i] - own));
const shadeAt = (shades, share) => shades[Math.min(Math.max(Math.floor(share * SHADES), 0), SHADES - 1)];
const luma = ([red, green, blue]) => 0.299 * red + 0.587 * green + 0.114 * blue;  // ITU-R BT.601, 0 to 255

// The colour at a place in a closed circle of colours: 0 is the first, 0.5 half way to the second; after the last comes the
// first again.
function between(colours, place) {
    const low = Math.floor(place);
    const [from, to] = [low, low + 1].map((i) => channelsOf(colours[i % colours.length]));
    return mixed(from, to, place - low);
}

// Hue in sixths of the circle from red, 0 to 6; 0 for greys.
function hueOf([red, green, blue]) {
    const most = Math.max(red, green, blue), range = most - Math.min(red, green, blue);
    if (range <= 0) return 0;
    if (most === red) return ((green - blue) / range + 6) % 6;
    return most === green ? 2 + (blue - red) / range : 4 + (red - green) / range;
}

// Relative luminance in sRGB, 0 to 1: IEC 61966-2-1.
function luminance(colour) {
    const [red, green, blue] = channelsOf(colour).map((channel) => {
        const value = channel / 255;
        return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

// Has the names of palette.json, with the values of the theme and the palette that were chosen last.
class Colours {
    // file: what palette.json says.
    constructor(file) {
        this.file = file;
        this.version = 0;  // grows with each choice, for what is kept of colours
        this.choose("dark", "standard");
    }

    choose(theme, palette) {
        Object.assign(this, this.file, theme === "light" ? this.file.light : {});
        this.isForColourBlind = palette === "color_blind";
        if (this.isForColourBlind) this.link_by_emitter = this.file.color_blind.link_by_emitter;
        const hues = this.isForColourBlind ? this.file.color_blind.led_by_hue : TURN;
        const shades = (place) => Array.from({length: SHADES}, (_, i) => place(i / (SHADES - 1)));
        const most = this.colour_map.length - 1;
        this.shades = {
            number: shades((share) => hexOf(between(this.colour_map, share * most))),
            angle: shades((share) => hexOf(between(hues, hues.length * (share + 0.5)))),  // from -pi; 0 is red
        };
        const channels = ([name, own]) => [name, own.map(channelsOf)];
        this.shadeChannels = Object.fromEntries(Object.entries(this.shades).map(channels));  // [red, green, blue] of each
        this.leds = new Cache(MOST_COLOURS);
        this.contrasts = new Cache(MOST_COLOURS);
        this.version++;
    }

    // A value of an LED, 0xRRGGBB, on the screen; above that: of what has none. As led_brightness() in palette.py.
    ofLed(packed, dark = this.dark_led) {
        if (!packed) return dark;
        if (packed > 0xffffff) return this.no_led;
        return this.leds.get(packed, () => {
            const channels = [packed >> 16, packed >> 8 & 255, packed & 255].map((value) => {
                const share = Math.min(Math.max((value - this.dimmest_led) / (this.brightest_led - this.dimmest_led), 0), 1);
                const [low, high] = [this.dimmest_led_on_screen, this.brightest_led_on_screen];
                return value ? Math.round(low + share * (high - low)) : 0;
            });
            return this.ofLight(hexOf(channels));
        });
    }

    // The colour of a light on the screen: for people with any colour vision, the same brightness in a distinct hue.
    ofLight(colour) {
        if (!this.isForColourBlind) return colour;
        const plain = channelsOf(colour), most = Math.max(...plain);
        const saturation = (most - Math.min(...plain)) / Math.max(most, 1);
        const brightness = Math.min(most / this.brightest_led_on_screen, 1);
        const hues = this.file.color_blind.led_by_hue;
        const coloured = between(hues, hueOf(plain)).map((channel) => brightness * channel);
        return hexOf(mixed([most, most, most], coloured, saturation));
    }

    // The colour of a value between two limits; `shades`: of a "number" or an "angle".
    ofValue(shades, value, from, to) {
        const place = to > from ? (value - from) / (to - from) : 0.5;
        return shadeAt(this.shades[shades], place);
    }

    // Whichever stands out from another colour.
    contrastTo(colour) {
        return this.contrasts.get(colour, () => luma(channelsOf(colour)) > 64 ? this.edge : this.paper);
    }

    // Whichever has the larger contrast ratio to another colour (WCAG 2.1).
    ofTextOn(colour) {
        const below = luminance(colour);
        const [paper, edge] = [this.paper, this.edge].map((text) => {
            const own = luminance(text);
            return (Math.max(own, below) + 0.05) / (Math.min(own, below) + 0.05);
        });
        return paper > edge ? this.paper : this.edge;
    }
}
