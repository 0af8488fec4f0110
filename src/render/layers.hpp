// The layers of a picture that change from one snapshot to the next. Each draws over what is there.
#pragma once

#include <cstdint>

#include "render/colour_key.hpp"
#include "render/scene.hpp"
#include "render/text.hpp"

namespace pogosim {

/// Where robots have been, in the colour their head LED had there, fading into the past.
void draw_trails(Scene const& scene);

/// Soft membranes: the line through their bodies, and these.
void draw_membranes(Scene const& scene);

/// The light of head LEDs on the floor around them.
void draw_glows(Scene const& scene);

/// The colour that the middle of a robot has: that of its head LED, or of its value.
Pixel body_colour(Scene const& scene, std::uint32_t robot);

/// Rigid objects with a mark where they head; lateral LEDs on the rim.
void draw_bodies(Scene const& scene, bool lateral_leds);

/// The marks where rigid objects head, once more, above what has been drawn over them.
void draw_headings(Scene const& scene);

/// Lamps as small suns, the outline of what they light, and beams.
void draw_lamps(Scene const& scene, Coverage& scratch);

/// Links between robots in range. The half next to a sender has the colour of its emitter; a two-way link is a whole
/// line, a one-way link fades from the middle on and ends in an arrow head at the listener.
void draw_links(Scene const& scene);

/// From -1, pushed, to 1, pulled.
Pixel tension_colour(ThemeColours const& colours, float load);

/// Links between bodies: springs and rods as lines from end to end, hinges as dots, in the colour of their tension.
void draw_body_links(Scene const& scene);

/// The ids of robots, on them, or beside them where they are small.
void draw_labels(Scene const& scene, Text& text);

/// Arrows from bodies to where they would be after a second, as they moved in the last step.
void draw_velocities(Scene const& scene);

/// Arrows from senders to robots that got a message of theirs in the last second; older ones are fainter.
void draw_heard(Scene const& scene);

/// A ring around a robot; a line along the outline of a wall or membrane.
void draw_selection(Scene const& scene, std::uint32_t robot, Coverage& scratch);

/// A bar of a round length, bottom left.
void draw_scale_bar(Scene const& scene, Text& text);

/// The time, top right.
void draw_time(Scene const& scene, Text& text);

/// Longest of 1, 2, 5 times a power of ten that is at most `longest`, which is above 0.
double round_length(double longest);

}  // namespace pogosim
