#include "render/theme_colours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <vector>

namespace pogosim {
namespace {

using Triple = std::array<double, 3>;
using Matrix = std::array<Triple, 3>;

// What a colour is to people without one kind of cones, in linear RGB: G. M. Machado, M. M. Oliveira, L. A. F.
// Fernandes, "A Physiologically-based Model for Simulation of Color Vision Deficiency", IEEE TVCG 15, 2009, severity 1.
constexpr std::array<Matrix, 4> kVisions{{
    {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
    {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
    {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}},
}};

Triple times(Matrix const& matrix, Triple const& vector) {
    Triple product{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            product[i] += matrix[i][k] * vector[k];
        }
    }
    return product;
}

Triple linear_rgb(Pixel colour) {
    auto const channel = [&](unsigned shift) {
        double const value = static_cast<double>(colour >> shift & 0xFFU) / 255.0;
        return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
    };
    return {channel(16), channel(8), channel(0)};
}

/// CIELAB (1976) under D65.
Triple lab(Triple const& rgb) {
    constexpr Matrix kToXyz{{{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}}};
    constexpr Triple kWhite{0.9505, 1.0, 1.089};
    Triple f = times(kToXyz, rgb);
    for (std::size_t i = 0; i < 3; ++i) {
        double const share = std::max(f[i], 0.0) / kWhite[i];
        f[i] = share > 0.008856 ? std::cbrt(share) : 7.787 * share + 16.0 / 116.0;
    }
    return {116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])};
}

/// The least difference of two colours of a list to anyone; 2 is just seen.
double least_difference(std::vector<Pixel> const& colours) {
    double least = 1e9;
    for (Matrix const& vision : kVisions) {
        for (std::size_t i = 0; i < colours.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                Triple const a = lab(times(vision, linear_rgb(colours[i])));
                Triple const b = lab(times(vision, linear_rgb(colours[k])));
                least = std::min(least, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
            }
        }
    }
    return least;
}

ThemeColours for_colour_blind() {
    return theme_colours({.palette = PaletteKind::color_blind});
}

std::vector<Pixel> led_hues(ThemeColours const& colours) {
    std::vector<Pixel> hues;
    for (Rgb const led :
         {Rgb{25, 0, 0}, Rgb{25, 25, 0}, Rgb{0, 25, 0}, Rgb{0, 25, 25}, Rgb{0, 0, 25}, Rgb{25, 0, 25}}) {
        hues.push_back(colours.of_led(led));
    }
    return hues;
}

TEST(ThemeColours, OfLedsAndLinksAreDistinctToEveryoneInThePaletteForTheColourBlind) {
    EXPECT_LT(least_difference(led_hues({})), 12.0);
    EXPECT_GT(least_difference(led_hues(for_colour_blind())), 12.0);
    auto const& links = for_colour_blind().link_by_emitter;
    EXPECT_GT(least_difference({links.begin(), links.end()}), 12.0);
}

TEST(ThemeColours, OfAnLedKeepItsBrightnessAndSaturationInAnotherHue) {
    ThemeColours const colours = for_colour_blind();
    EXPECT_EQ(colours.of_led({0, 0, 0}), colours.dark_led);
    EXPECT_EQ(colours.of_led({25, 25, 25}), ThemeColours{}.of_led({25, 25, 25}));  // white has no hue
    EXPECT_EQ(colours.of_led({25, 0, 0}), palette::color_blind::kLedByHue[0]);
    EXPECT_LT(colours.of_led({5, 0, 0}) >> 16U & 0xFFU, colours.of_led({25, 0, 0}) >> 16U & 0xFFU);
}

TEST(ThemeColours, OfTheMapGetBrighterAllTheWay) {
    double before = -1.0;
    for (int i = 0; i <= 100; ++i) {
        double const lightness = lab(linear_rgb(ThemeColours::of_share(static_cast<float>(i) / 100.0F)))[0];
        EXPECT_GT(lightness, before) << i;
        before = lightness;
    }
    EXPECT_EQ(ThemeColours::of_share(-1.0F), palette::kColourMap.front());
    EXPECT_EQ(ThemeColours::of_share(2.0F), palette::kColourMap.back());
}

TEST(ThemeColours, OfAnglesGoRoundTheCircle) {
    for (ThemeColours const& colours : {ThemeColours{}, for_colour_blind()}) {
        EXPECT_EQ(colours.of_angle(0.5F), colours.of_angle(0.5F + 6.2831853F));
        std::set<Pixel> found;
        for (int i = 0; i < 12; ++i) {
            found.insert(colours.of_angle(static_cast<float>(i) * 0.5236F));
        }
        EXPECT_EQ(found.size(), 12U);
    }
}

TEST(ThemeColours, OfWritingStandOutInBothThemes) {
    for (Theme const theme : {Theme::dark, Theme::light}) {
        ThemeColours const colours = theme_colours({.theme = theme});
        for (Pixel const below :
             {colours.floor, colours.paper, colours.dark_led, colours.no_led, colours.of_led({0, 0, 25})}) {
            Triple const a = lab(linear_rgb(below));
            EXPECT_GT(std::abs(a[0] - lab(linear_rgb(colours.contrast_to(below)))[0]), 25.0) << std::hex << below;
            EXPECT_GT(std::abs(a[0] - lab(linear_rgb(colours.of_text_on(below)))[0]), 40.0) << std::hex << below;
        }
        std::vector<Pixel> const on_floor{colours.link_by_emitter.begin(), colours.link_by_emitter.end()};
        for (Pixel const colour : on_floor) {
            EXPECT_GT(std::abs(lab(linear_rgb(colour))[0] - lab(linear_rgb(colours.floor))[0]), 25.0)
                << std::hex << colour;
        }
    }
}

}  // namespace
}  // namespace pogosim
