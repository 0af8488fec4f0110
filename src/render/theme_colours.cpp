#include "render/theme_colours.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

namespace pogosim {

namespace {

/// The channels of a colour, red, green and blue, 0 to 255.
using Channels = std::array<float, 3>;

Channels channels_of(Pixel colour) {
    return {static_cast<float>(colour >> 16U & 0xFFU), static_cast<float>(colour >> 8U & 0xFFU),
            static_cast<float>(colour & 0xFFU)};
}

/// Relative luminance in sRGB, 0 to 1: IEC 61966-2-1.
float luminance(Pixel colour) {
    auto const linear = [](float channel) {
        float const value = channel / 255.0F;
        return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
    };
    auto const [red, green, blue] = channels_of(colour);
    return 0.2126F * linear(red) + 0.7152F * linear(green) + 0.0722F * linear(blue);
}

Pixel pixel_of(Channels const& channels) {
    auto const rounded = [](float channel) { return static_cast<Pixel>(std::clamp(channel, 0.0F, 255.0F) + 0.5F); };
    return 0xFF000000U | rounded(channels[0]) << 16U | rounded(channels[1]) << 8U | rounded(channels[2]);
}

Channels mixed(Channels const& from, Channels const& to, float share) {
    Channels mixture{};
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        mixture[i] = from[i] + share * (to[i] - from[i]);
    }
    return mixture;
}

/// Between the colours of a list, at a place from 0, the first, to its size - 1.
Channels between(std::span<Pixel const> colours, float place) {
    std::size_t const low = std::min(static_cast<std::size_t>(place), colours.size() - 1);
    std::size_t const high = std::min(low + 1, colours.size() - 1);
    return mixed(channels_of(colours[low]), channels_of(colours[high]), place - static_cast<float>(low));
}

/// Hue of a colour in sixths of the circle from red, 0 to 6, by its channels; 0 for greys.
float hue_of(Channels const& colour) {
    auto const [red, green, blue] = colour;
    float const most = std::max({red, green, blue});
    float const range = most - std::min({red, green, blue});
    if (range <= 0.0F) {
        return 0.0F;
    }
    if (most == red) {
        float const hue = (green - blue) / range;
        return hue < 0.0F ? hue + 6.0F : hue;
    }
    return most == green ? 2.0F + (blue - red) / range : 4.0F + (red - green) / range;
}

/// The colour of a hue, 0 to 6, that people with any colour vision tell from the others: M. Okabe and K. Ito, "Color
/// Universal Design", 2008.
Channels distinct_hue(float hue) {
    auto const& hues = palette::color_blind::kLedByHue;
    float const place = std::fmod(hue, static_cast<float>(hues.size()));
    auto const low = static_cast<std::size_t>(place);
    return mixed(channels_of(hues[low % hues.size()]), channels_of(hues[(low + 1) % hues.size()]),
                 place - static_cast<float>(low));
}

}  // namespace

Pixel ThemeColours::in_distinct_hue(Pixel colour) {
    Channels const plain = channels_of(colour);
    float const most = std::max({plain[0], plain[1], plain[2]});
    float const saturation = (most - std::min({plain[0], plain[1], plain[2]})) / std::max(most, 1.0F);
    float const brightness = std::min(most / palette::kBrightestLedOnScreen, 1.0F);
    Channels const hue = distinct_hue(hue_of(plain));
    Channels coloured{};
    std::ranges::transform(hue, coloured.begin(), [&](float channel) { return brightness * channel; });
    return pixel_of(mixed({most, most, most}, coloured, saturation));
}

Pixel ThemeColours::contrast_to(Pixel colour) const {
    auto const [red, green, blue] = channels_of(colour);
    float const luma = 0.299F * red + 0.587F * green + 0.114F * blue;  // ITU-R BT.601
    return luma > 0.25F * 255.0F ? edge : paper;
}

Pixel ThemeColours::of_text_on(Pixel colour) const {
    float const below = luminance(colour);
    auto const ratio = [&](Pixel text) {
        float const own = luminance(text);
        return (std::max(own, below) + 0.05F) / (std::min(own, below) + 0.05F);
    };
    return ratio(paper) > ratio(edge) ? paper : edge;
}

Pixel ThemeColours::of_share(float share) {
    auto const& map = palette::kColourMap;
    float const within = std::clamp(share, 0.0F, 1.0F);
    return pixel_of(between(map, within * static_cast<float>(map.size() - 1)));
}

Pixel ThemeColours::of_angle(float angle_rad) const {
    constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
    float const turns = angle_rad / kTurn - std::floor(angle_rad / kTurn);
    float const hue = std::min(6.0F * turns, 5.9999F);
    if (for_colour_blind) {
        return pixel_of(distinct_hue(hue));
    }
    static constexpr std::array<Pixel, 7> kHues{0xFFFF0000U, 0xFFFFFF00U, 0xFF00FF00U, 0xFF00FFFFU,
                                                0xFF0000FFU, 0xFFFF00FFU, 0xFFFF0000U};
    return pixel_of(between(kHues, hue));
}

ThemeColours theme_colours(ViewOptions const& options) {
    ThemeColours colours;
    if (options.theme == Theme::light) {
        namespace light = palette::light;
        colours.floor = light::kFloor;
        colours.wall = light::kWall;
        colours.edge = light::kEdge;
        colours.no_led = light::kNoLed;
        colours.dark_led = light::kDarkLed;
        colours.dark_wall = light::kDarkWall;
        colours.lamplight = light::kLamplight;
        colours.lamp = light::kLamp;
        colours.lamp_outline = light::kLampOutline;
        colours.link_by_emitter = light::kLinkByEmitter;
        colours.link_by_all_emitters = light::kLinkByAllEmitters;
        colours.link_at_rest = light::kLinkAtRest;
        colours.link_pulled = light::kLinkPulled;
        colours.link_pushed = light::kLinkPushed;
        colours.heard = light::kHeard;
        colours.selection_rim = light::kSelectionRim;
    }
    if (options.palette == PaletteKind::color_blind) {
        colours.link_by_emitter = palette::color_blind::kLinkByEmitter;
        colours.for_colour_blind = true;
    }
    return colours;
}

}  // namespace pogosim
