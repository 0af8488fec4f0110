// The colours of a picture, by theme and palette: those of python/pogosim/palette.json, and the circle of hues for
// directions.
#pragma once

#include <array>

#include "render/led_colour.hpp"
#include "render/palette.hpp"
#include "world/rgb.hpp"
#include "world/view_options.hpp"

namespace pogosim {

struct ThemeColours {
    Pixel paper = palette::kPaper;
    Pixel floor = palette::kFloor;
    Pixel wall = palette::kWall;
    Pixel edge = palette::kEdge;
    Pixel ink = palette::kInk;
    Pixel dark_led = palette::kDarkLed;
    Pixel no_led = palette::kNoLed;
    Pixel dark_wall = palette::kDarkWall;
    Pixel lamplight = palette::kLamplight;
    Pixel lamp = palette::kLamp;
    Pixel lamp_outline = palette::kLampOutline;
    std::array<Pixel, 4> link_by_emitter = palette::kLinkByEmitter;
    Pixel link_by_all_emitters = palette::kLinkByAllEmitters;
    Pixel link_at_rest = palette::kLinkAtRest;
    Pixel link_pulled = palette::kLinkPulled;
    Pixel link_pushed = palette::kLinkPushed;
    Pixel heard = palette::kHeard;
    Pixel selection = palette::kSelection;
    Pixel selection_rim = palette::kSelectionRim;
    bool for_colour_blind = false;  // hues of LEDs are replaced, see of_led()

    friend bool operator==(ThemeColours const&, ThemeColours const&) = default;

    /// The colour of an LED on the screen; `dark`: of one that is off.
    Pixel of_led(Rgb led, Pixel dark) const {
        Pixel const colour = led_colour(led, dark);
        return for_colour_blind && is_lit(led) ? in_distinct_hue(colour) : colour;
    }
    Pixel of_led(Rgb led) const { return of_led(led, dark_led); }

    /// The paper or edge colour, whichever stands out from another one.
    Pixel contrast_to(Pixel colour) const;

    /// The paper or edge colour, whichever has the larger contrast ratio to another one (WCAG 2.1): for text.
    Pixel of_text_on(Pixel colour) const;

    /// The colour of a share of 0 to 1 of the range of a column, from dark to bright.
    static Pixel of_share(float share);

    /// The colour of a direction or phase, rad: opposite ones differ most.
    Pixel of_angle(float angle_rad) const;

private:
    /// The same brightness and saturation in a hue that people with any colour vision tell from others.
    static Pixel in_distinct_hue(Pixel colour);
};

ThemeColours theme_colours(ViewOptions const& options);

}  // namespace pogosim
