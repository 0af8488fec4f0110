// What all writing in a picture has in common: sizes, and a plate on which it is legible.
#pragma once

#include "render/scene.hpp"

namespace pogosim {

/// In points, see Scene.
inline constexpr float kNotePad = 5.0F;
inline constexpr float kNoteMargin = 6.0F;

/// Size of the font of notes, pixels.
int note_font_px(Scene const& scene);

/// A rectangle with round corners on which text is legible, whatever is below.
void draw_plate(Scene const& scene, PixelBox const& box);

/// Whether a plate of that size fits into the picture, with its margin.
bool plate_fits(Scene const& scene, int width, int height);

int whole(float value);

}  // namespace pogosim
